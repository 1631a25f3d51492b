"""From a photo's nearest node on to where it was taken, by where the map puts both, and a turn to face it."""

import math

from services.planner.goals.nodes import why_not_beside
from services.planner.mapping.reach import claims
from services.planner.ports import Decision, MapAccess, Matcher, Observation
from services.planner.profiles import Profile
from services.planner.surroundings import free_way_m
from services.planner.travel.following.last_leg import REACHED_M, reckoned_rad
from services.planner.travel.following.waypoints import SLOWEST
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.resection import resected
from shared.mapgraph.photographs.search import PhotoPlace

COMPARED = 8
"""Nodes around the spot that a frame is compared with; chosen: as many as localise a frame of goto."""
LEG_STEPS = 60.0
"""Frames of the rest of the way, turning on the spot counted less; chosen: twice what 1.3 m take."""
FACED_RAD = math.radians(4.0)
"""Who looks this near to the photo's direction looks as it does; chosen: a fifth of what is right."""
TURN_STEPS = 60
"""Frames of turning before it is left at that; chosen: half a turn takes 20."""


class LastMetre:
    """Drives and turns near the node of a photo's place; ends looking as the photo does."""

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, place: PhotoPlace) -> None:
        self._profile, self._maps, self._matcher, self._place = profile, maps, matcher, place
        self._here = Displacement(place.node)
        self._there = False
        self._leg_left, self._turns_left = LEG_STEPS, TURN_STEPS

    def decide(self, observation: Observation) -> Decision:
        """One frame."""
        self._locate(observation)
        if not self._there:
            going = self._go_on(observation)
            if going is not None:
                return going
            self._there = True
        return self._turn()

    def _locate(self, observation: Observation) -> None:
        """Where the robot is relative to the place's node: by what it sees around, else by how it moved."""
        self._here = self._here.moved(observation.moved)
        graph, node = self._maps.graph, self._place.node
        seen = claims(graph, self._matcher.match(graph.nearest(node, COMPARED)), self._profile)
        self._here = resected(graph, seen, node, NEAR_NODES) or self._here

    def _go_on(self, observation: Observation) -> Decision | None:
        """The next step to the spot; None where it is reached, or nothing free leads on."""
        here, place = self._here, self._place
        if against := why_not_beside(self._maps, place.node, (here.x_m, here.y_m), (place.x_m, place.y_m)):
            return Decision("hold", why=against, outcome="failed", failure="forbidden")
        spot = Displacement(place.node, place.x_m, place.y_m, place.yaw_rad)
        heading_rad = reckoned_rad(self._maps.graph, here, spot)
        self._leg_left -= observation.frame_share
        if heading_rad is None or self._leg_left < 0.0:
            return None
        left_m = self._left_m()
        if free_way_m(observation.ranges, heading_rad, self._profile) < min(left_m, REACHED_M):
            return None
        slow = min(1.0, max(SLOWEST, left_m))
        why = f"{left_m:.1f} m to where the photo was taken"
        return Decision("go", heading_rad, speed_fraction=slow, distance_m=left_m, method="map", why=why)

    def _left_m(self) -> float:
        return math.hypot(self._place.x_m - self._here.x_m, self._place.y_m - self._here.y_m)

    def _turn(self) -> Decision:
        off_rad = math.remainder(self._place.yaw_rad - self._here.yaw_rad, math.tau)
        told = f"{math.degrees(off_rad):.0f} degrees from the photo's direction"
        left_m = self._left_m()
        short = f"{left_m:.1f} m from " if left_m > REACHED_M else ""
        if abs(off_rad) <= FACED_RAD or self._turns_left <= 0:
            return Decision("hold", why=f"{short}where the photo was taken, {told}", outcome="succeeded")
        self._turns_left -= 1
        return Decision("hold", face_rad=off_rad, why=f"turning: {told}")
