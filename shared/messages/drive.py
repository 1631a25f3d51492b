"""Where to go and how to get there. Planner -> drive -> robot; a person's hand -> drive."""

import math
from typing import Annotated, ClassVar, Literal

from pydantic import Field

from shared.messages.base import Bearing, Message, Name

Speed = Annotated[float, Field(ge=-20.0, le=20.0)]
"""Metres a second along an axis of the robot."""

TurnRate = Annotated[float, Field(ge=-20.0, le=20.0)]
"""Radians a second, counter-clockwise positive."""


class Heading(Message):
    """Direction to drive in, decided from frame `seq`.

    Attributes:
        action: "go" along heading_rad or "hold" still for this frame.
        face_rad: with "hold", turn on the spot until the front looks there; None to stand. A base that cannot
            turn on the spot stands.
        s_cv: similarity with the current via point; slows the robot near it (thesis eq. 6.5).
        s_slow: similarity above which it slows down (thesis: 90).
        s_max: largest possible similarity (thesis: 150).
        speed_fraction: further limit on speed near the goal, 0 to 1.
        distance_m: about how far what is headed for was from that frame, right to a factor of 1.5 or so; None
            where nothing in particular is headed for.
        epoch: a planner with a higher epoch replaces one with a lower.
    """

    SCHEMA: ClassVar[str] = "heading.v1"

    robot: Name
    mission_id: str = Field(default="", max_length=64)
    epoch: int = Field(default=0, ge=0)
    ttl_ms: int = Field(default=500, ge=1, le=60_000)
    action: Literal["go", "hold"] = "go"
    heading_rad: Bearing = 0.0
    face_rad: Bearing | None = None
    s_cv: int = Field(default=0, ge=0)
    s_slow: int = Field(default=0, ge=0)
    s_max: int = Field(default=1, ge=1)
    speed_fraction: float = Field(default=1.0, ge=0.0, le=1.0)
    distance_m: float | None = Field(default=None, ge=0.0, le=1_000.0)
    method: str = Field(default="", max_length=32)
    why: str = Field(default="", max_length=400)


class Velocity(Message):
    """How the robot is to move, in its own frame; what its wheels do for that is its own affair.

    Attributes:
        seq: of the frame it answers.
        forward_mps, left_mps, turn_radps: ahead, to the left (0 for a base that cannot), counter-clockwise.
        ttl_ms: the robot stands so long after it came, unless another one came.
        epoch: of the planner whose heading it follows.
        at_ns: when it was decided, by the clock that stamps the robot's distances; 0 where that is not known.
        avoiding: whether something near turned or slowed what was wished.
    """

    SCHEMA: ClassVar[str] = "velocity.v1"

    robot: Name
    epoch: int = Field(default=0, ge=0)
    ttl_ms: int = Field(default=500, ge=1, le=60_000)
    forward_mps: Speed = 0.0
    left_mps: Speed = 0.0
    turn_radps: TurnRate = 0.0
    at_ns: int = Field(default=0, ge=0, lt=2**63)
    avoiding: bool = False
    why: str = Field(default="", max_length=400)

    @property
    def speed_mps(self) -> float:
        """Speed over the floor, whatever the direction."""
        return math.hypot(self.forward_mps, self.left_mps)

    @property
    def stands(self) -> bool:
        """Whether the robot is to stand still: neither to go nor to turn."""
        return self.forward_mps == self.left_mps == self.turn_radps == 0.0


class Manual(Message):
    """A person drives: how the robot is to move for as long as this is said again.

    A mission that runs pauses and can be resumed. Of several people the first keeps the robot until they let
    it go or are silent for their ttl. Drive obeys within its own limits: it slows down before what is near
    and stands before it touches, and an emergency stop holds as ever.

    Attributes:
        seq: a counter of the sender: of two messages the later one has more.
        who: drives; a name that people know.
        action: "drive", or "release" to let the robot go at once.
        forward_mps, left_mps, turn_radps: as in `Velocity`.
        ttl_ms: the robot stands so long after the last of these messages; say it three times as often.
    """

    SCHEMA: ClassVar[str] = "manual.v1"

    robot: Name
    who: str = Field(min_length=1, max_length=64)
    action: Literal["drive", "release"] = "drive"
    forward_mps: Speed = 0.0
    left_mps: Speed = 0.0
    turn_radps: TurnRate = 0.0
    ttl_ms: int = Field(default=400, ge=1, le=1_000)
