"""Missions: what a robot is asked to do, how it goes and why. Gateway <-> planner."""

import math
from typing import Annotated, Any, ClassVar, Literal

from pydantic import AfterValidator, Field, JsonValue

from shared.messages.base import Message, Name, Part
from shared.messages.features import Features

MissionState = Literal["idle", "running", "paused", "succeeded", "failed", "cancelled"]
FailureKind = Literal[
    "",
    "goal_not_in_map",
    "ambiguous",
    "lost",
    "blocked",
    "cancelled",
    "no_path",
    "timeout",
    "service_lost",
    "forbidden",
]


CONTROLS = ("pause", "resume", "cancel", "finish", "status")
"""Actions that are no kind of mission."""

KindName = Annotated[str, Field(pattern=r"^[a-z0-9_-]{0,64}$")]
"""Name of a kind of mission, or "" for none. Which there are, the planner says (`MissionKinds`)."""


def _portable(value: Any) -> Any:
    """Refuse, at any depth, numbers that JSON or msgpack has not."""
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("numbers must be finite")
    if isinstance(value, int) and not -(2**63) <= value < 2**64:
        raise ValueError("integers must fit into 64 bits")
    for inner in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        _portable(inner)
    return value


Parameters = Annotated[dict[str, JsonValue], Field(max_length=64), AfterValidator(_portable)]
"""What a kind of mission asks for, by name; its own model checks them."""


PausedBy = Literal["", "person", "by_hand", "emergency_stop"]
"""What a paused mission waits for: a person who paused it or drives by hand, or the stop's clearing."""


class MissionRequest(Message):
    """Start, pause, resume, cancel, finish or ask.

    Attributes:
        action: one of CONTROLS, or the kind of mission to start.
        parameters: of the kind.
        goal: features of a goal picture, for kinds that take one.
        goal_node: the parameter of that name, from senders that know no parameters.
        mission_id: of the mission to start; of a control, the only one that it is for, "" for any.
        checkpoint: how far the same mission had got before.
        max_steps: frames after which it is given up; of a kind with checkpoints, frames since the last one.
    """

    SCHEMA: ClassVar[str] = "mission_request.v1"

    action: Name
    map: Name = "default"
    mission_id: str = Field(default="", max_length=64)
    parameters: Parameters = Field(default_factory=dict)
    checkpoint: Parameters = Field(default_factory=dict)
    goal: Features | None = None
    goal_node: int | None = None
    seed: int = Field(default=0, ge=0)
    max_steps: int = Field(default=20_000, ge=1)


class EventValue(Part):
    """One named figure of an event or a mission."""

    name: str = Field(max_length=64)
    value: float | int | str | bool | None


class MissionStatus(Message):
    """The state of a robot's current or last mission, published at every step.

    Attributes:
        figures: those that the kind's record shows.
        paused_by: what it waits for while it is paused.
        travel: state of the travel machine (deploy/TRAVEL.md); "" while the mission does not travel.
        travel_reason: of its last transition.
    """

    SCHEMA: ClassVar[str] = "mission_status.v1"
    MAX_ITEMS: ClassVar[int] = 25_000

    robot: Name
    mission_id: str = ""
    action: str = ""
    map: Name = "default"
    state: MissionState = "idle"
    failure: FailureKind = ""
    reason: str = Field(default="", max_length=400)
    step: int = 0
    nodes: int = 0
    edges: int = 0
    open_directions: int = 0
    via_points: tuple[int, ...] = Field(default=(), fail_fast=True)
    via_index: int = 0
    nearest_node: int | None = None
    similarity: int = 0
    disparity_rad: float | None = None
    epoch: int = 0
    figures: tuple[EventValue, ...] = Field(default=(), max_length=64, fail_fast=True)
    paused_by: PausedBy = ""
    travel: str = Field(default="", max_length=32)
    travel_reason: str = Field(default="", max_length=200)


class MissionKindInfo(Part):
    """What other processes need to know of a kind of mission.

    Attributes:
        title: for people, as on a button.
        parameters: JSON Schema of its parameters.
        shown: figures that its record shows, by their names in the status.
        takes_picture: whether a goal picture may come with the request.
        by_hand: whether it goes along with a person who drives, and ends when told to finish.
    """

    name: Name
    title: str = Field(default="", max_length=100)
    parameters: Parameters = Field(default_factory=dict)
    shown: tuple[Annotated[str, Field(max_length=64)], ...] = Field(default=(), max_length=32)
    takes_picture: bool = False
    by_hand: bool = False


class MissionKindsRequest(Message):
    """Ask a planner which kinds of mission it knows."""

    SCHEMA: ClassVar[str] = "mission_kinds_request.v1"


class MissionKinds(Message):
    """The kinds of mission of one planner, by name."""

    SCHEMA: ClassVar[str] = "mission_kinds.v1"

    kinds: tuple[MissionKindInfo, ...] = Field(default=(), max_length=256, fail_fast=True)


class Event(Message):
    """One decision with its reason, for people and for the recorder."""

    SCHEMA: ClassVar[str] = "event.v1"

    robot: Name
    mission_id: str = ""
    step: int = 0
    kind: str = Field(max_length=64)
    reason: str = Field(default="", max_length=400)
    values: tuple[EventValue, ...] = Field(default=(), fail_fast=True)
