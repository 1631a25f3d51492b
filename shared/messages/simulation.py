"""Simulation only: the true pose for evaluation and the debug view, and the hand of the experimenter."""

from typing import ClassVar, Literal

from pydantic import Field

from shared.messages.base import Message, Name, Part
from shared.messages.sensors import Frame


class Pose(Part):
    """A pose on the floor of the world."""

    x_m: float
    y_m: float
    yaw_rad: float = Field(ge=-6.3, le=6.3)


class Truth(Message):
    """Where everything really is. Never read by planner, features or drive."""

    SCHEMA: ClassVar[str] = "truth.v1"

    robot: Name
    world: Name
    pose: Pose
    hider: Pose | None = None
    sim_time_s: float = 0.0
    speed_mps: float = 0.0
    collisions: int = Field(default=0, ge=0)
    render_ms: float = 0.0


class SimulationRequest(Message):
    """reset: start pose, noise from seed; place_robot; place_hider and look: reply with a picture."""

    SCHEMA: ClassVar[str] = "simulation_request.v1"

    action: Literal["reset", "place_robot", "place_hider", "remove_hider", "look", "truth"]
    pose: Pose | None = None
    seed: int | None = Field(default=None, ge=0)


class SimulationReply(Message):
    """The true state after the request and, where one was asked for, a picture."""

    SCHEMA: ClassVar[str] = "simulation_reply.v1"

    truth: Truth
    frame: Frame | None = None
