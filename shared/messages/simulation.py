"""Simulation only: the true pose for evaluation and the debug view, and the hand of the experimenter."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from shared.messages.base import Message, Name, Part
from shared.messages.sensors import Frame

Item = Annotated[str, Field(min_length=1, max_length=80)]
"""Name of a piece of furniture, or of a kind of it, as world files have them."""


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
    """What the experimenter's hand does in the world.

    Attributes:
        action: reset puts the robot at the start pose and draws noise from seed; place_robot; place_hider and
            look reply with a picture; set_item takes the furniture `item` away, puts it back or moves it;
            place_obstacle adds furniture of a `kind` at `pose`, with `item` as its name; set_light lets it
            become another time of day.
        item: name of a piece of furniture: its own, or kind and number as in "chair-2".
        kind: of the furniture catalogue.
        present: false takes the item away, true puts it back where the world file has it.
        illumination: the time of day, from noon (0) over dusk (0.5) to lamps only (1).
    """

    SCHEMA: ClassVar[str] = "simulation_request.v1"

    action: Literal[
        "reset",
        "place_robot",
        "place_hider",
        "remove_hider",
        "look",
        "truth",
        "set_item",
        "place_obstacle",
        "set_light",
    ]
    pose: Pose | None = None
    seed: int | None = Field(default=None, ge=0)
    item: Item | None = None
    kind: Item | None = None
    present: bool | None = None
    illumination: float | None = Field(default=None, ge=0.0, le=1.0)


class SimulationReply(Message):
    """The true state after the request and, where one was asked for, a picture."""

    SCHEMA: ClassVar[str] = "simulation_reply.v1"

    truth: Truth
    frame: Frame | None = None
