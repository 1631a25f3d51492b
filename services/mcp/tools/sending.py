"""Tools that send the robot somewhere. None says how fast."""

from typing import Annotated, Any

from mcp.server.mcpserver import MCPServer
from mcp.server.mcpserver.exceptions import ToolError
from mcp.types import ToolAnnotations
from pydantic import Field

from services.mcp.answers.missions import Mission
from services.mcp.gateway import Gateway
from services.mcp.tools.photos import Photo, picture_of

SENDS = ToolAnnotations(read_only_hint=False, destructive_hint=False, idempotent_hint=False)

PlaceName = Annotated[str, Field(max_length=64, description="as `list_places` has it")]
Sign = Annotated[str, Field(max_length=64, description="what it says, as `room 214`")]
PlaceNames = Annotated[
    list[PlaceName], Field(min_length=1, max_length=64, description="in the order of visits")
]
RouteName = Annotated[str, Field(min_length=1, max_length=64, description="as `list_routes` has it")]
Back = Annotated[bool, Field(description="from its end to its beginning")]
Rounds = Annotated[int, Field(ge=1, le=1000, description="how often all of it")]
Dwell = Annotated[float, Field(ge=0.0, le=600.0, description="seconds to stay at each place")]
Node = Annotated[int | None, Field(ge=0, lt=2**63, description="a node of the map")]
Steps = Annotated[int, Field(ge=1, le=20_000, description="give up after so many pictures")]
Seed = Annotated[int, Field(ge=0, lt=2**63, description="of every random draw")]


def add_sending(server: MCPServer[Any], gateway: Gateway) -> None:
    """Give the server its tools that start missions."""

    @server.tool(annotations=SENDS)
    async def go_to(
        place: PlaceName = "",
        sign: Sign = "",
        node: Node = None,
        photo: Photo = "",
        max_steps: Steps = 1500,
        seed: Seed = 0,
    ) -> Mission:
        """Start driving to a place, a sign, a node or where a panorama or photo was taken; then `wait`."""
        if [bool(place), bool(sign), node is not None, bool(photo)].count(True) != 1:
            raise ToolError("say where to by one of place, sign, node and photo")
        if photo:
            return Mission.of(await gateway.goto_photo(picture_of(photo), seed, max_steps))
        where = {"place": place} if place else {"sign": sign} if sign else {"goal_node": node}
        return Mission.of(await gateway.start("goto", where, seed, max_steps))

    @server.tool(annotations=SENDS)
    async def explore(max_steps: Steps = 5000, seed: Seed = 0) -> Mission:
        """Start exploring what the map does not show yet. Then `wait`, again and again: it takes long."""
        return Mission.of(await gateway.start("explore", {}, seed, max_steps))

    @server.tool(annotations=SENDS)
    async def patrol(
        places: PlaceNames,
        rounds: Rounds = 1,
        dwell_s: Dwell = 0.0,
        max_steps: Steps = 20_000,
        seed: Seed = 0,
    ) -> Mission:
        """Start driving from place to place; what cannot be reached is left out and told. Then `wait`."""
        wish = {"places": places, "rounds": rounds, "dwell_s": dwell_s}
        return Mission.of(await gateway.start("patrol", wish, seed, max_steps))

    @server.tool(annotations=SENDS)
    async def follow_route(
        route: RouteName, reverse: Back = False, rounds: Rounds = 1, max_steps: Steps = 20_000, seed: Seed = 0
    ) -> Mission:
        """Start driving to the first node of a route and exactly along it, there or back. Then `wait`."""
        wish = {"route": route, "reverse": reverse, "rounds": rounds}
        return Mission.of(await gateway.start("route", wish, seed, max_steps))
