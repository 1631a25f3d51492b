"""What every base is asked and answers, and its limits. Pure."""

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

from pydantic import BaseModel, ConfigDict, PositiveFloat

from shared.geometry.clearance import Obstacles

BaseName = Literal["holonomic", "differential", "ackermann"]


class BaseLimits(BaseModel):
    """What the robot rolls on, and how fast it may turn.

    Attributes:
        name: holonomic rolls in any direction; differential goes ahead and turns on the spot; ackermann
            steers as a car does.
        turn_radps: fastest turn; chosen: 1.5 rad/s, a quarter turn a second; a TurtleBot 4 may do 1.9.
        radius_m: least turning radius of a car, of the middle of the axle that does not steer; chosen: that
            of the simulator's (0.31 m) and a quarter, so that it can still correct.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    name: BaseName = "holonomic"
    turn_radps: PositiveFloat = 1.5
    radius_m: PositiveFloat = 0.4


class Twist(NamedTuple):
    """A velocity in the robot's frame: metres and radians a second."""

    forward_mps: float = 0.0
    left_mps: float = 0.0
    turn_radps: float = 0.0


@dataclass(frozen=True)
class Course:
    """Where to go, how fast, and what stands around.

    Attributes:
        heading_rad: direction, robot frame.
        speed_mps: along it.
        distance_m: about how far what is headed for is; inf where nobody knows or it is passed.
        obstacles: what the distance sensors see.
        body_m: radius of the disc that must fit.
        contact_s: time that must be left before anything would be touched.
    """

    heading_rad: float
    speed_mps: float
    obstacles: Obstacles
    body_m: float
    contact_s: float
    distance_m: float = math.inf

    def slowed(self, bend_per_m: float, *, backwards: bool = False) -> float:
        """Speed on an arc: that of the course, or less where something stands on the arc."""
        free_m = self.obstacles.arc_clearance_m(bend_per_m, self.body_m, backwards=backwards)
        return min(self.speed_mps, free_m / self.contact_s)


@dataclass(frozen=True)
class Manoeuvre:
    """What a base remembers between steps.

    Attributes:
        gear: +1 ahead, -1 backwards.
        turn: +1 to the left, -1 to the right while it turns round in several moves; 0 while it does not.
    """

    gear: int = 1
    turn: int = 0
