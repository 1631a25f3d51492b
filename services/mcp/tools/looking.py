"""Tools and resources that look: they move nothing."""

from typing import Annotated, Any

from mcp.server.mcpserver import Image, MCPServer
from mcp.types import ToolAnnotations
from pydantic import Field

from services.mcp.answers.missions import RobotFacts
from services.mcp.answers.places import Whereabouts
from services.mcp.gateway import Gateway
from services.mcp.tools.photos import Photo, picture_of

LOOKS = ToolAnnotations(read_only_hint=True)

Width = Annotated[int, Field(ge=64, le=2048, description="of the picture, twice its height")]


def add_looking(server: MCPServer[Any], gateway: Gateway) -> None:
    """Give the server its tools and resources that look."""

    @server.tool(annotations=LOOKS, structured_output=False)
    async def look(width_px: Width = 1024) -> Image:
        """What the robot sees all around: a panorama. Its middle is ahead, its left half is to the left."""
        return Image(data=await gateway.frame(width_px), format="jpeg")

    @server.tool(annotations=LOOKS)
    async def where_am_i() -> Whereabouts:
        """Where in the map the robot is, by what it sees now: nodes of the map."""
        return Whereabouts.of(await gateway.whereabouts())

    @server.tool(annotations=LOOKS)
    async def locate(photo: Photo) -> Whereabouts:
        """Where in the map a panorama or a photo was taken, without driving there."""
        return Whereabouts.of(await gateway.check_photo(picture_of(photo)))

    @server.tool(annotations=LOOKS)
    async def how_is_it() -> RobotFacts:
        """How the robot is: its mission, its emergency stop, its battery, how old its newest picture is."""
        return RobotFacts.of(await gateway.robot_facts())

    @server.resource("topnav://map", mime_type="application/json")
    async def read_map() -> dict[str, Any]:
        """Name, counts and revision of the map."""
        return await gateway.map_facts()

    @server.resource("topnav://report", mime_type="application/json")
    async def read_report() -> dict[str, Any]:
        """The last mission that ended, with its figures."""
        return await gateway.newest_run()
