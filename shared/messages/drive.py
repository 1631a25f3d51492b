"""Where to go and how to get there. Planner -> drive -> robot."""

from typing import ClassVar, Literal

from pydantic import Field

from shared.messages.base import Bearing, Message, Name


class Heading(Message):
    """Direction to drive in, decided from frame `seq`.

    Attributes:
        action: "go" along heading_rad or "hold" still for this frame.
        s_cv: similarity with the current via point; slows the robot near it (thesis eq. 6.5).
        s_slow: similarity above which it slows down (thesis: 90).
        s_max: largest possible similarity (thesis: 150).
        speed_fraction: further limit on speed near the goal, 0 to 1.
        epoch: a planner with a higher epoch replaces one with a lower.
    """

    SCHEMA: ClassVar[str] = "heading.v1"

    robot: Name
    mission_id: str = Field(default="", max_length=64)
    epoch: int = Field(default=0, ge=0)
    ttl_ms: int = Field(default=500, ge=1, le=60_000)
    action: Literal["go", "hold"] = "go"
    heading_rad: Bearing = 0.0
    s_cv: int = Field(default=0, ge=0)
    s_slow: int = Field(default=0, ge=0)
    s_max: int = Field(default=1, ge=1)
    speed_fraction: float = Field(default=1.0, ge=0.0, le=1.0)
    method: str = Field(default="", max_length=32)
    why: str = Field(default="", max_length=400)


class Command(Message):
    """Steer all wheels to one angle and turn them. `seq` is the frame it answers."""

    SCHEMA: ClassVar[str] = "command.v1"

    robot: Name
    epoch: int = Field(default=0, ge=0)
    ttl_ms: int = Field(default=500, ge=1, le=60_000)
    steer_rad: Bearing = 0.0
    wheel_speed_radps: float = Field(default=0.0, ge=-100.0, le=100.0)
    avoiding: bool = False
    why: str = Field(default="", max_length=400)
