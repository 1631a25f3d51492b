"""Whether the bearing back to the node just left turns as it must while the robot drives away. Pure."""

import math
from dataclasses import dataclass

from services.planner.mapping.edges import CONFIDENCE_MIN
from services.planner.profiles import Profile
from services.planner.similarity import CLOSE, similarity
from shared.messages.matching import NodeMatch

FIRST_JUMP_RAD = math.radians(90.0)
"""The bearing back is about opposite to the way at first; the robot may still get round something: a quarter
turn."""

JUMP_RAD = math.radians(25.0)
"""Then it turns slowly and never jumps so far between two frames; chosen: a step of 0.12 m aside at 0.3 m
turns it by 22 degrees, further away by less."""


@dataclass
class BackBearing:
    """The bearing back, frame by frame; a jump means an aliased view (decision 0015)."""

    back_rad: float | None = None

    def follows(self, origin: NodeMatch | None, heading_rad: float, profile: Profile) -> bool:
        """Whether it turned smoothly since the last frame, and remember it.

        Close to the node it may turn by anything: the robot passes the spot on its way out.

        Args:
            origin: the frame against the node that was left.
            heading_rad: direction of the departure, robot frame.
            profile: thresholds.
        """
        if origin is None or origin.heading_rad is None or origin.confidence < CONFIDENCE_MIN:
            return True
        if similarity(origin, profile) > CLOSE * profile.mapping.s_node_max:
            return True
        expected, jump_rad = heading_rad + math.pi, FIRST_JUMP_RAD
        if self.back_rad is not None:
            expected, jump_rad = self.back_rad, JUMP_RAD
        if abs(math.remainder(origin.heading_rad - expected, math.tau)) > jump_rad:
            return False
        self.back_rad = origin.heading_rad
        return True
