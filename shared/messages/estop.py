"""The emergency stop: who wants it or ends it, and how it stands. Anybody -> drive <-> robot."""

from typing import ClassVar, Literal

from pydantic import Field

from shared.messages.base import Message, Name


class EStopRequest(Message):
    """Stop the robot, let it go again, or ask how it stands.

    Attributes:
        action: anybody may engage; clear needs a person's name in `who`.
    """

    SCHEMA: ClassVar[str] = "estop_request.v1"

    action: Literal["engage", "clear", "status"]
    who: str = Field(default="", max_length=64)
    why: str = Field(default="", max_length=400)


class EStopState(Message):
    """How the emergency stop stands. `seq` counts its changes: of two states the later one has more.

    Attributes:
        engaged: the wheels stand, whatever is commanded.
        who: engaged it, or cleared it; empty while nobody ever did.
        since_ns: when that was, nanoseconds since the Unix epoch by the clock of the drive service.
    """

    SCHEMA: ClassVar[str] = "estop_state.v1"

    robot: Name
    engaged: bool
    who: str = Field(default="", max_length=64)
    why: str = Field(default="", max_length=400)
    since_ns: int = Field(default=0, ge=0, lt=2**63)
