"""To where an ordinary photo was taken, and look as it does: to its nearest node, on to the spot, turn.

A photo shows too little to steer by. Its matches with several nodes together tell its pose near one of them
(shared/mapgraph/photographs); from that node on the robot goes by where the map puts both.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from services.planner.mapping.reach import claims
from services.planner.ports import Decision, MapAccess, Matcher, Mission, Note, Observation, Progress
from services.planner.profiles import Profile
from services.planner.surroundings import free_way_m
from services.planner.travel.last_leg import REACHED_M, reckoned_rad
from services.planner.travel.waypoints import SLOWEST
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.resection import resected
from shared.mapgraph.photographs.photo_matches import PHOTO_NODES, photo_matches
from shared.mapgraph.photographs.search import PhotoPlace
from shared.mapgraph.photographs.verdict import PhotoAnswer, located
from shared.messages.features import Features, PhotoView

COMPARED = 8
"""Nodes around the spot that a frame is compared with; chosen: as many as localise a frame of goto."""
LEG_STEPS = 60.0
"""Frames of the rest of the way, turning on the spot counted less; chosen: twice what 1.3 m take."""
FACED_RAD = math.radians(4.0)
"""Who looks this near to the photo's direction looks as it does; chosen: a fifth of what is right."""
TURN_STEPS = 60
"""Frames of turning before it is left at that; chosen: half a turn takes 20."""

TravelTo = Callable[[Features], Mission]


class PhotoGoto:
    """Travels to a photo's place and faces what it shows; ends there or with a typed failure."""

    def __init__(
        self,
        profile: Profile,
        maps: MapAccess,
        matcher: Matcher,
        goal: Features,
        view: PhotoView,
        travel_to: TravelTo,
        rng: np.random.Generator,
    ) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self._goal, self._view, self._travel_to, self._rng = goal, view, travel_to, rng
        self._place: PhotoPlace | None = None
        self._travel: Mission | None = None
        self._travelled = self._there = False
        self._here: Displacement | None = None
        self._leg_left, self._turns_left = LEG_STEPS, TURN_STEPS

    @property
    def progress(self) -> Progress:
        """Where it stands."""
        return Progress() if self._travel is None else self._travel.progress

    def decide(self, observation: Observation) -> Decision:
        """One frame; in the first one the photo is located in the map."""
        if self._place is None or self._travel is None:
            return self._begin(observation)
        if not self._travelled:
            return self._travelling(self._travel, observation)
        here = self._locate(self._place, observation)
        if not self._there:
            going = self._rest_of_the_way(self._place, here, observation)
            if going is not None:
                return going
            self._there = True
        return self._turn(self._place, here)

    def _begin(self, observation: Observation) -> Decision:
        matches = photo_matches(self._view, self._matcher.locate(self._goal, PHOTO_NODES).values())
        answer = located(self._maps.graph, matches, self._rng)
        if answer.verdict != "found":
            return _refused(answer)
        place = self._place = answer.places[0]
        self._travel = self._travel_to(self._maps.features_of(place.node))
        where = f"{math.hypot(place.x_m, place.y_m):.1f} m from node {place.node}"
        note = Note("goal_located", f"the photo was taken {where}: {place.keypoints} of its keypoints agree")
        decision = self._travelling(self._travel, observation)
        return replace(decision, notes=(note, *decision.notes))

    def _travelling(self, travel: Mission, observation: Observation) -> Decision:
        decision = travel.decide(observation)
        if decision.outcome != "succeeded":
            return decision
        self._travelled = True
        return replace(
            decision, action="hold", outcome="", why=f"at the photo's nearest node: {decision.why}"
        )

    def _locate(self, place: PhotoPlace, observation: Observation) -> Displacement:
        """Where the robot is relative to the place's node: by what it sees around, else by how it moved."""
        graph = self._maps.graph
        matches = self._matcher.match(graph.nearest(place.node, COMPARED))
        before = (self._here or Displacement(place.node)).moved(observation.moved)
        seen = claims(graph, matches, self._profile)
        self._here = resected(graph, seen, place.node, NEAR_NODES) or before
        return self._here

    def _rest_of_the_way(
        self, place: PhotoPlace, here: Displacement, observation: Observation
    ) -> Decision | None:
        """The next step to the spot; None where it is reached, or nothing free leads on."""
        spot = Displacement(place.node, place.x_m, place.y_m, place.yaw_rad)
        heading_rad = reckoned_rad(self._maps.graph, here, spot)
        self._leg_left -= observation.frame_share
        if heading_rad is None or self._leg_left < 0.0:
            return None
        left_m = math.hypot(place.x_m - here.x_m, place.y_m - here.y_m)
        if free_way_m(observation.ranges, heading_rad, self._profile) < min(left_m, REACHED_M):
            return None
        slow = min(1.0, max(SLOWEST, left_m))
        why = f"{left_m:.1f} m to where the photo was taken"
        return Decision("go", heading_rad, speed_fraction=slow, distance_m=left_m, method="map", why=why)

    def _turn(self, place: PhotoPlace, here: Displacement) -> Decision:
        off_rad = math.remainder(place.yaw_rad - here.yaw_rad, math.tau)
        told = f"{math.degrees(off_rad):.0f} degrees from the photo's direction"
        if abs(off_rad) <= FACED_RAD or self._turns_left <= 0:
            return Decision("hold", why=f"where the photo was taken, {told}", outcome="succeeded")
        self._turns_left -= 1
        return Decision("hold", face_rad=off_rad, why=f"turning: {told}")


def _refused(answer: PhotoAnswer) -> Decision:
    if answer.verdict == "not_found":
        why = "the map explains too little of the photo"
        return Decision("hold", why=why, outcome="failed", failure="goal_not_in_map")
    nodes = [place.node for place in answer.places]
    why = f"the photo can have been taken near each of nodes {nodes}"
    if answer.verdict == "weak":
        why = f"the photo was taken somewhere about node {nodes[0]}, where is not clear"
    return Decision("hold", why=why, outcome="failed", failure="ambiguous")
