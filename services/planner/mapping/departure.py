"""Leaving a place in an unexplored direction. Pure."""

import math
from dataclasses import dataclass

from services.planner.mapping.places import CONFIDENCE_MIN
from services.planner.profiles import Profile
from services.planner.similarity import CLOSE, similarity
from shared.messages.matching import NodeMatch

FIRST_JUMP_RAD = math.radians(90.0)
"""The direction back is about opposite to the way at first; the robot may still get round something."""

JUMP_RAD = math.radians(25.0)
"""Then it turns slowly while the robot drives away; it never jumps so far between two frames."""


@dataclass
class Departure:
    """Leaving `node_id` through `sector`, straight on in the direction `heading_rad` (robot frame)."""

    node_id: int
    sector: int
    heading_rad: float
    steps: int = 0
    unseen_steps: int = 0
    retreating: bool = False
    back_rad: float | None = None

    def follows(self, origin: NodeMatch | None, profile: Profile) -> bool:
        """Whether the direction back turned smoothly since the last frame; a jump means a look-alike view.

        Close to the place the direction may turn by anything: the robot passes it on its way out.
        """
        if origin is None or origin.heading_rad is None or origin.confidence < CONFIDENCE_MIN:
            return True
        if similarity(origin, profile) > CLOSE * profile.s_node_max:
            return True
        expected, jump_rad = self.heading_rad + math.pi, FIRST_JUMP_RAD
        if self.back_rad is not None:
            expected, jump_rad = self.back_rad, JUMP_RAD
        if abs(math.remainder(origin.heading_rad - expected, math.tau)) > jump_rad:
            return False
        self.back_rad = origin.heading_rad
        return True
