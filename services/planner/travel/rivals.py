"""Where else a robot can be that found itself at one of several places that look alike.

Rooms furnished alike do not tell which of them it is in; the corridor before them does. So each of the places
is followed by what the robot does, and weighed by what it sees, until one of them is far likelier than that
by which it goes.
"""

from collections.abc import Sequence

from services.planner.mapping.reach import in_reach, nodes_nearby
from services.planner.ports import MapAccess, Matches
from services.planner.profiles import Profile
from services.planner.travel.following.last_leg import reckoned
from services.planner.travel.sights import Sights
from services.planner.travel.whereabouts import Rival, Whereabouts
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import Hypothesis
from shared.motion.motion import Motion

LOOK_M = 0.5
"""Way between two views that are weighed; chosen: nodes lie so far apart at the least."""
AROUND = 3
"""Nodes around each place that a view is compared with; chosen: as many as its core has."""
SHARPNESS, LEAST_SHARE = 2.0, 0.2
"""A place with a share of the matches that the best one has is as likely as this power of it makes it, and
never less than that of the least share; chosen."""
TAKES_OVER, DROPPED = 4.0, 0.02
"""A place so many times as likely as the one by which the robot goes takes its place; one of so little is
forgotten; chosen."""
SAME_M = 1.0
"""Places nearer to each other than this are one; chosen."""


class Rivals:
    """Follows the places at which a robot can be besides the one by which it goes.

    Args:
        profile: thresholds.
        maps: the map.
        sights: reads what frames say of it.
        whereabouts: of the robot.
    """

    def __init__(self, profile: Profile, maps: MapAccess, sights: Sights, whereabouts: Whereabouts) -> None:
        self._profile, self._maps, self._sights, self._at = profile, maps, sights, whereabouts
        self._since_m = 0.0

    @property
    def are_due(self) -> bool:
        """Whether the next view should be compared with the whole map, to tell one from the others."""
        return bool(self._at.rivals) and self._since_m >= LOOK_M

    def nodes(self) -> list[int]:
        """Nodes around each of them, to be compared with that view whatever resembles it more."""
        if not self.are_due:
            return []
        graph, profile = self._maps.graph, self._profile
        around = [nodes_nearby(graph, rival.here, profile, AROUND) for rival in self._at.rivals]
        return list(dict.fromkeys(node for nodes in around for node in nodes))

    def begin(self, places: Sequence[Hypothesis], matches: Matches) -> None:
        """The robot goes by the first of some places at which a frame can have been taken."""
        self.end()
        for place in places[1:]:
            here = self._sights.resected({node: matches[node] for node in place.nodes}, place.nodes[0])
            if here is not None:
                self._at.rivals.append(Rival(here, _likely(place.core, places[0].core)))

    def end(self) -> None:
        """It is known where the robot is, or nothing is."""
        self._at.rivals, self._since_m = [], 0.0

    def went(self, moved: Motion) -> None:
        """The robot went on, wherever it is."""
        self._since_m += moved.way_m
        nodes = self._maps.graph.nodes
        self._at.rivals = [
            Rival(rival.here.moved(moved), rival.odds)
            for rival in self._at.rivals
            if rival.here.node_id in nodes
        ]

    def choose(self, here: Displacement, matches: Matches) -> Displacement:
        """By which place the robot goes from now on.

        Args:
            here: by which it goes.
            matches: of the frame, with the nodes around each place and with those of the map most like it.
        """
        if not self.are_due:
            return here
        self._since_m = 0.0
        looks = [self._look(rival, matches) for rival in (Rival(here), *self._at.rivals)]
        most = max(core for _, core in looks)
        if not most:
            return here
        places = [Rival(rival.here, rival.odds * _likely(core, most)) for rival, core in looks]
        best = max(places, key=lambda rival: rival.odds)
        chosen = best if best.odds >= TAKES_OVER * places[0].odds else places[0]
        others = [Rival(one.here, one.odds / chosen.odds) for one in places if one is not chosen]
        self._at.rivals = [one for one in others if one.odds >= DROPPED and self._is_apart(chosen, one)]
        return here if chosen is places[0] else chosen.here

    def _look(self, rival: Rival, matches: Matches) -> tuple[Rival, int]:
        """A place as the view corrects it, and the matches that speak for it."""
        within = in_reach(self._maps.graph, matches, rival.here, self._profile)
        found = self._sights.groups(within)
        if not found:
            return rival, 0
        best = max(found, key=lambda place: place.core)
        seen = self._sights.resected({node: matches[node] for node in best.nodes})
        is_surer = seen is not None and seen.spread_m <= rival.here.spread_m
        return Rival(seen, rival.odds) if is_surer and seen is not None else rival, best.core

    def _is_apart(self, one: Rival, other: Rival) -> bool:
        spot = reckoned(self._maps.graph, one.here, other.here)
        return spot is None or spot[1] >= SAME_M


def _likely(core: int, most: int) -> float:
    """How likely a place is whose matches are so many, beside one that has the most."""
    return float(max(core / most, LEAST_SHARE) ** SHARPNESS) if most else 1.0
