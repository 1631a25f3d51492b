"""Lost: sweeps that grow until something known is seen, or patience ends. Pure."""

import math
from dataclasses import dataclass

FIRST_STEPS = 6
"""Steps of the first sweep; chosen: 0.7 m back, where a node was last seen (nodes lie 0.7 m apart)."""

GROWTH = 1.5
"""Each sweep is longer by half: decision 0014."""

TURN_RAD = math.radians(137.5)
"""The golden angle: later sweeps never repeat an earlier direction."""


@dataclass
class Search:
    """Where to go while nothing is recognised: back along the last heading first, then ever longer sweeps.

    Directions are kept in the robot's frame: `turned` keeps them up where it turns. Obstacles are passed by
    the drive service.

    Attributes:
        heading_rad: of the present sweep, robot frame.
        patience_steps: steps after which the search is given up.
    """

    heading_rad: float
    patience_steps: int
    steps: float = 0.0
    left: float = FIRST_STEPS
    sweep_steps: float = FIRST_STEPS

    @property
    def exhausted(self) -> bool:
        """Whether to give up."""
        return self.steps >= self.patience_steps

    def turned(self, turn_rad: float) -> None:
        """The robot turned, counter-clockwise."""
        self.heading_rad = math.remainder(self.heading_rad - turn_rad, math.tau)

    def next_heading(self, frame_share: float = 1.0) -> float:
        """Heading of this step, which counts for so much of one: less where the robot only turned."""
        if self.left <= 0:
            self.sweep_steps *= GROWTH
            self.left = round(self.sweep_steps)
            self.heading_rad = math.remainder(self.heading_rad + TURN_RAD, math.tau)
        self.left -= frame_share
        self.steps += frame_share
        return self.heading_rad


def search_back(last_heading_rad: float, patience_steps: int) -> Search:
    """A search that starts by going back."""
    return Search(math.remainder(last_heading_rad + math.pi, math.tau), patience_steps)
