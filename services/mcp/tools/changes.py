"""A tool that tells what inspections found."""

import unicodedata
from typing import Annotated, Any

from mcp.server.mcpserver import Image, MCPServer
from mcp.server.mcpserver.exceptions import ToolError
from mcp.types import CallToolResult, ImageContent, TextContent, ToolAnnotations
from pydantic import Field

from services.mcp.answers.changes import Round
from services.mcp.caller import Facts
from services.mcp.gateway import Gateway

PlaceName = Annotated[str, Field(max_length=64, description="only this place, with both pictures")]
RoundId = Annotated[
    str,
    Field(
        max_length=74,
        pattern=r"^([A-Za-z0-9_-]{1,64}-[0-9]{1,9})?$",
        description="as an answer has it; empty: the newest, or the newest with that place",
    ),
]


def add_changes(server: MCPServer[Any], gateway: Gateway) -> None:
    """Give the server its tool about changes."""

    @server.tool(annotations=ToolAnnotations(read_only_hint=True))
    async def what_changed(place: PlaceName = "", round_id: RoundId = "") -> Annotated[CallToolResult, Round]:
        """What the last inspection found that was taken away, brought or moved since the visit before.

        With a place also its pictures, panoramas: the one before, where it was compared, then the newer one.
        A task of kind `inspect` makes a new round.
        """
        told = _newest(await gateway.inspections(), place, round_id)
        answer = Round.of(told)
        content: list[TextContent | ImageContent] = [
            TextContent(type="text", text=answer.model_dump_json(indent=2))
        ]
        for visit in told["visits"] if place else ():
            content += await _pictures(gateway, told["round"], visit)
        return CallToolResult(content=[*content], structured_content=answer.model_dump(mode="json"))


async def _pictures(gateway: Gateway, round_id: str, visit: Facts) -> list[TextContent | ImageContent]:
    """Both pictures of a visit, each after a word that says which it is; of two the earlier first."""
    shown: list[TextContent | ImageContent] = []
    for word, before in (("before", True), ("now", False)):
        if before and visit["against_ns"] is None:
            continue
        try:
            picture = await gateway.inspected(round_id, visit["place"], before=before)
        except ToolError as error:  # only the newest pictures of a place are kept
            shown.append(TextContent(type="text", text=f"{word}: {error}"))
            continue
        shown.append(TextContent(type="text", text=f"{word}:"))
        shown.append(Image(data=picture, format="jpeg").to_image_content())
    return shown


def _newest(rounds: list[Facts], place: str, round_id: str) -> Facts:
    """The newest round that is meant, with the visits that are meant.

    Raises:
        ToolError: there is none.
    """
    for told in rounds:
        visits = [each for each in told["visits"] if not place or _key(each["place"]) == _key(place)]
        if visits and round_id in ("", told["round"]):
            return {**told, "visits": visits}
    which = " ".join([*([repr(round_id)] if round_id else []), *([f"with place {place!r}"] if place else [])])
    raise ToolError(f"no round of an inspection {which}".rstrip() + " is kept")


def _key(name: str) -> str:
    """What names have in common that mean the same place."""
    return " ".join(unicodedata.normalize("NFC", name).split()).casefold()
