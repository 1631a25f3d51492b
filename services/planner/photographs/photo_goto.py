"""To where an ordinary photo was taken, and look as it does: to its nearest node, then the last metre.

A photo shows too little to steer by. Its matches with several nodes together tell its pose near one of them
(shared/mapgraph/photographs).
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from services.planner.goals.nodes import why_not_beside
from services.planner.photographs.last_metre import LastMetre
from services.planner.ports import Decision, MapAccess, Matcher, Mission, Note, Observation, Progress
from services.planner.profiles import Profile
from shared.mapgraph.photographs.photo_matches import PHOTO_NODES, photo_matches
from shared.mapgraph.photographs.verdict import PhotoAnswer, located
from shared.messages.features import Features, PhotoView

TravelTo = Callable[[int], Mission]


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
        self._travel: Mission | None = None
        self._last_metre: LastMetre | None = None
        self._travelled = False

    @property
    def progress(self) -> Progress:
        """Where it stands."""
        return Progress() if self._travel is None else self._travel.progress

    def decide(self, observation: Observation) -> Decision:
        """One frame; in the first one the photo is located in the map."""
        if self._travel is None or self._last_metre is None:
            return self._begin(observation)
        if self._travelled:
            return self._last_metre.decide(observation)
        return self._travelling(self._travel, observation)

    def _begin(self, observation: Observation) -> Decision:
        matches = photo_matches(self._view, self._matcher.locate(self._goal, PHOTO_NODES).values())
        answer = located(self._maps.graph, matches, self._rng)
        if answer.verdict != "found":
            return _refused(answer)
        place = answer.places[0]
        if against := why_not_beside(self._maps, place.node, (0.0, 0.0), (place.x_m, place.y_m)):
            return Decision("hold", why=against, outcome="failed", failure="forbidden")
        self._last_metre = LastMetre(self._profile, self._maps, self._matcher, place)
        self._travel = self._travel_to(place.node)
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


def _refused(answer: PhotoAnswer) -> Decision:
    if answer.verdict == "not_found":
        why = "the map explains too little of the photo"
        return Decision("hold", why=why, outcome="failed", failure="goal_not_in_map")
    nodes = [place.node for place in answer.places]
    why = f"the photo can have been taken near each of nodes {nodes}"
    if answer.verdict == "weak":
        why = f"the photo was taken somewhere about node {nodes[0]}, where is not clear"
    return Decision("hold", why=why, outcome="failed", failure="ambiguous")
