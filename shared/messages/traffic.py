"""Rights of way: robots of one map ask before they drive on. Planner -> fleet."""

from typing import Annotated, ClassVar

from pydantic import Field

from shared.messages.base import Message, Name

Way = Annotated[tuple[int, ...], Field(max_length=20_000, fail_fast=True)]
"""Nodes of a map in the order in which a robot passes them."""


class WayRequest(Message):
    """Where a robot is and where it wants to go, said again at least once a second.

    Attributes:
        at: nodes between which it is, the one that it heads for last; empty where it does not know.
        ahead: nodes of its way beyond; empty while it stands, searches or maps.
        busy: on a mission, and gone from there some time.
    """

    SCHEMA: ClassVar[str] = "way_request.v1"
    MAX_ITEMS: ClassVar[int] = 50_000

    robot: Name
    map: Name = "default"
    at: Way = ()
    ahead: Way = ()
    busy: bool = False


class WayReply(Message):
    """How far it may go.

    Attributes:
        free: how many of the nodes ahead are its own until it passed them, or is silent.
        why: what the next one waits for.
        room: nodes of the way by which it is to make room for others first; empty where it need not.
    """

    SCHEMA: ClassVar[str] = "way_reply.v1"
    MAX_ITEMS: ClassVar[int] = 50_000

    free: int = Field(default=0, ge=0)
    why: str = Field(default="", max_length=200)
    room: Way = ()
