"""The places where a picture can have been taken, and where a robot is relative to them."""

import math

from services.planner.goals.picture_levels import largest
from services.planner.mapping.reach import claims, distances, elsewhere
from services.planner.ports import MapAccess, Matches
from services.planner.profiles import Profile
from services.planner.similarity import similarity
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import Hypothesis, hypotheses
from shared.mapgraph.local.likely_places import is_plain, likely, typical_similarity
from shared.mapgraph.local.view_range import length_to_m
from shared.messages.matching import NodeMatch

NEAREST = 2
"""Nodes most like the picture, of which one is next to whoever stands where it was taken; chosen: one before
and one beyond."""
SPOT_M = 0.75
"""Who is nearer than this to the node most like the picture stands where it was taken; chosen: nodes lie half
a metre apart, and a base stops a hand's breadth short."""
BEYOND_FACTOR = 2.0
"""A picture was taken within so many times the distance that its matches with a node stand for: in nine of
ten edges of three worlds that is right to a factor of 1.6."""
LOOKED_AT = 3
"""Nodes of each place whose pictures are compared with the goal: of four places the likeliest is the goal's
for 79 of 90 goals in a hotel and a hostel of development, for 64 by matches alone."""
UNLIKELY_FACTOR = 3.0
"""A place whose nodes differ so many times more than those of another is unlikely: those of the right one
1.6 times at most, for 90 goals in a hotel and a hostel of development."""


class Candidates:
    """The places that a picture resembles, the most alike first.

    Args:
        maps: the map.
        found: the picture against the nodes most like it.
        profile: thresholds.

    Attributes:
        places: what it can show.
        plain: whether it is plain which place it shows, or that nothing tells.
        unlikely: places whose nodes look other than those of the likeliest.
    """

    def __init__(self, maps: MapAccess, found: Matches, profile: Profile) -> None:
        self._maps, self._profile = maps, profile
        self._yaw_rad = {node: match.yaw_rad or 0.0 for node, match in found.items()}
        self.places = self._likely(found)
        self.plain = not self.places or is_plain(self.places, typical_similarity(maps.graph))
        self.unlikely: frozenset[Hypothesis] = frozenset()

    @property
    def names(self) -> str:
        """The node most like the picture of each place, for people."""
        return ", ".join(str(place.nodes[0]) for place in self.places)

    def to_look_at(self) -> list[int]:
        """Nodes whose pictures may tell which place is the likeliest."""
        return [node for place in self.places for node in place.nodes[:LOOKED_AT]]

    def look(self, seen: Matches) -> None:
        """Put the likeliest place first: that whose nodes differ least from the picture, as pictures.

        Args:
            seen: the picture against those nodes.
        """
        levels = {node: largest(m.differences) for node, m in seen.items() if m.differences is not None}
        differ = {
            place: min((levels[n] for n in place.nodes if n in levels), default=math.inf)
            for place in self.places
        }
        least = min(differ.values(), default=math.inf)
        self.places.sort(key=lambda place: differ[place])
        self.unlikely = frozenset(p for p in self.places if UNLIKELY_FACTOR * least <= differ[p] < math.inf)

    def nearest(self, node: int | None) -> Hypothesis | None:
        """The place a node belongs to, by the fewest edges; None where there is no doubt."""
        graph = self._maps.graph
        if self.plain or node is None or node not in graph.nodes:
            return None
        of = {n: place for place in self.places for n in place.nodes}
        return next((of[n] for n in graph.nearest(node, len(graph.nodes)) if n in of), None)

    def is_at(self, here: Displacement | None) -> bool:
        """Whether the robot stands where a place in doubt puts the picture, as far as is known."""
        return not self.plain and here is not None and self.is_within(SPOT_M, here)

    def is_within(self, far_m: float, here: Displacement) -> bool:
        """Whether the robot is so near to the node most like the picture of any place, as far as is known."""
        best = {place.nodes[0] for place in self.places}
        return min(distances(self._maps.graph, here, best).values(), default=math.inf) < far_m

    def is_near(self, node: int | None) -> bool:
        """Whether a robot about `node` can be at the place, where there is but one and both are known."""
        graph = self._maps.graph
        if not (self.plain and self.places) or node is None or node not in graph.nodes:
            return self.plain
        return any(node == best or node in graph.neighbours(best) for best in self.places[0].nodes[:NEAREST])

    def is_elsewhere(self, goal: NodeMatch, here: Displacement | None) -> bool:
        """Whether the map has the picture elsewhere than it seems to be in sight; False where nobody knows.

        Doors along a corridor repeat: a period before its place a picture seems to have been taken here.

        Args:
            goal: the frame against the picture.
            here: where the frame was taken.
        """
        if not (self.plain and self.places) or here is None or self.is_near(here.node_id):
            return False
        nearest = self.places[0].nodes[0]
        seen = goal.model_copy(update={"yaw_rad": (goal.yaw_rad or 0.0) + self._yaw_rad[nearest]})
        return bool(elsewhere(self._maps.graph, {nearest: seen}, here, self._profile))

    def shows_another(self, view: Matches, here: Displacement | None) -> Hypothesis | None:
        """The place that a view is of, where the goal's is one alone and it is not that: a look-alike.

        Args:
            view: the frame against the nodes most like it.
            here: where the frame was taken; None where nobody knows.
        """
        found = self._likely(view)
        if not (self.plain and self.places and found):
            return None
        same = [not set(place.nodes).isdisjoint(self.places[0].nodes) for place in found]
        may_be = same[0] or (any(same) and self.is_near(None if here is None else here.node_id))
        if may_be and (here is None or not self._is_beyond(here)):
            return None
        return found[0]

    def _is_beyond(self, here: Displacement) -> bool:
        """Whether a robot is further from the place than matches with it allow, as far as is known."""
        graph, place = self._maps.graph, self.places[0]
        apart_m = length_to_m(graph, place.nodes[0], place.similarity)
        return not self.is_within(SPOT_M + BEYOND_FACTOR * apart_m, here)

    def _likely(self, matches: Matches) -> list[Hypothesis]:
        profile, graph = self._profile, self._maps.graph
        if profile.sensing.similarity == "raw":
            return []
        similar = {n: m for n, m in matches.items() if similarity(m, profile) > profile.travel.s_via_min}
        said = claims(graph, similar, profile)
        return likely(graph, said, hypotheses(graph, said))
