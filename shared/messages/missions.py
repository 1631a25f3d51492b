"""Missions: what a robot is asked to do, how it goes and why. Gateway <-> planner."""

from typing import ClassVar, Literal

from pydantic import Field

from shared.messages.base import Message, Name, Part
from shared.messages.features import Features

MissionState = Literal["idle", "running", "paused", "succeeded", "failed", "cancelled"]
FailureKind = Literal[
    "", "goal_not_in_map", "lost", "blocked", "cancelled", "no_path", "timeout", "service_lost"
]


class MissionRequest(Message):
    """Start, pause, resume, cancel or ask. A goto names its goal by picture or by node."""

    SCHEMA: ClassVar[str] = "mission_request.v1"

    action: Literal["explore", "goto", "pause", "resume", "cancel", "status"]
    map: Name = "default"
    mission_id: str = Field(default="", max_length=64)
    goal: Features | None = None
    goal_node: int | None = None
    seed: int = Field(default=0, ge=0)
    max_steps: int = Field(default=20_000, ge=1)


class MissionStatus(Message):
    """The state of a robot's current or last mission, published at every step."""

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


class EventValue(Part):
    """One named figure of an event."""

    name: str = Field(max_length=64)
    value: float | int | str | bool | None


class Event(Message):
    """One decision with its reason, for people and for the recorder."""

    SCHEMA: ClassVar[str] = "event.v1"

    robot: Name
    mission_id: str = ""
    step: int = 0
    kind: str = Field(max_length=64)
    reason: str = Field(default="", max_length=400)
    values: tuple[EventValue, ...] = Field(default=(), fail_fast=True)
