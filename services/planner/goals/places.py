"""Where a goal picture can have been taken, and which of these places is it: by going there.

Rooms furnished alike resemble a picture of one of them equally. Only at the very spot does the right one
resemble it more: so each is visited, and arrival is claimed where the others are excluded. Where that does
not tell, the robot goes back to the place that differs least, for a look from nearer by. Of a few, or in a
building whose rooms were told apart often enough before, the first one that fits is it.
"""

from collections import Counter
from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace

from services.planner.goals.candidates import Candidates
from services.planner.goals.place_evidence import PlaceEvidence, Visit
from services.planner.look_alikes import LookAlikes
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import Hypothesis
from shared.messages.matching import NodeMatch
from shared.messages.missions import FailureKind

SPOT_SHARE = 0.6
"""At the very spot view and goal share so much of what two frames from beside each other share, where its
place was in doubt; noise and light take from both alike. At 48 spots of two schools, an office and a
hostel, seen from 2 and 5 cm aside and turned, 0.83 and more; at an equal desk of another row 0.47 at most.
Rooms furnished alike have 0.68 and more: they exclude nothing. In a bare corridor the right spot has 0.46,
turned to another side: it fits as a picture."""
AROUND_M = 2.0
"""Who is nearer than this to it is in the same part of a room; chosen."""
TRIES = 2
"""Times the picture may be lost, refuted or the way shut at one place before that counts."""
WAYS_TRIED = 4
"""Ways to a place's nodes that may fail before it counts as shut; chosen: a bed on the spot shuts them all,
and a mission bears eight."""
LATER_M = 1000.0
"""Added to the ways to all places but the likeliest one, where that comes first; chosen: more than a building
has."""
EQUAL_RISK = 0.125
"""Accepted chance that the goal is at a place that nobody saw, see `LookAlikes.risk`; chosen: one place,
where two others could be told from the best one."""


@dataclass(frozen=True)
class Ruling:
    """Why an arrival is none yet ("" confirms it), and a `failure` where it never will be one."""

    why: str = ""
    failure: FailureKind = ""


class GoalPlaces:
    """What is known of the places of one goal picture, and which of them to go to.

    Args:
        candidates: its places.
        known: how often rooms of this map look alike in everything.
    """

    def __init__(self, candidates: Candidates, known: LookAlikes) -> None:
        self._candidates, self._known = candidates, known
        self._evidence = PlaceEvidence()
        self._losses: Counter[Hypothesis] = Counter()
        self._blocks: Counter[Hypothesis] = Counter()
        self._ways: Counter[Hypothesis] = Counter()
        self._shut: set[Hypothesis] = set()
        self._again: Hypothesis | None = None
        self._looked_nearer = set[Hypothesis]()
        self._has_looked_again = False

    @property
    def looks_again(self) -> bool:
        """Whether the robot goes back to a place that it visited, to see it from nearer by."""
        return self._again is not None

    def open_targets(self, targets: Mapping[int, float]) -> dict[int, float]:
        """Of the nodes that the goal resembles those of places that may still be it.

        Where the first that fits will do, the likeliest comes first, and others while no way leads there;
        unlikely ones come last.
        """
        if not self._candidates.places:
            return dict(targets)
        places = self._open()
        risk = self._evidence.risk(self._known, self._unseen(places[1:]))
        comes_first = self.looks_again or risk <= EQUAL_RISK
        later = {place: int(place in self._candidates.unlikely) for place in places}
        if comes_first:
            later |= {place: later[place] + 1 for place in places[1:]}
        more_m = {node: LATER_M * later[place] for place in places for node in place.nodes}
        return {node: cost + more_m[node] for node, cost in targets.items() if node in more_m}

    def without(self, targets: Mapping[int, float]) -> list[int]:
        """Of each place that has none of the targets the node most like the picture."""
        rivals = [] if self._candidates.plain else self._candidates.places
        return [place.nodes[0] for place in rivals if targets.keys().isdisjoint(place.nodes)]

    def sees(self, goal: NodeMatch, here: Displacement | None) -> None:
        """The picture is in view: how much of it differs counts where it is near by.

        Args:
            goal: the frame against the picture.
            here: where the frame was taken.
        """
        place = None if here is None else self._candidates.nearest(here.node_id)
        if place is not None and goal.differences is not None:
            self._evidence.looked(place, goal.differences)

    def stood(self, node: int | None) -> Ruling:
        """The robot stood at the very spot, and the goal picture did not agree with the view.

        The one place that there is gets another try: nothing else speaks against it, and one late picture
        may be all that was wrong.
        """
        place = self._candidates.nearest(node)
        if place is None:
            return Ruling("not seen")
        if len(self._candidates.places) == 1:
            return self.lost(node)
        self._evidence.visited(place, Visit())
        return self._judge(place)

    def refuted(self, here: Displacement | None) -> Ruling:
        """What agreed with the goal was another view: at the very spot it counts, near by the second one."""
        place = None if here is None else self._candidates.nearest(here.node_id)
        if here is None or place is None:
            return Ruling("not there")
        if not self._candidates.is_at(here):
            self._losses[place] += self._candidates.is_within(AROUND_M, here)
            if self._losses[place] < TRIES:
                return Ruling("not there")
        return self.stood(here.node_id)

    def arrived(self, node: int | None, visit: Visit) -> Ruling:
        """The robot stands where the goal picture agrees with the view.

        Args:
            node: of the map, near there.
            visit: what it sees of the goal.
        """
        place = self._candidates.nearest(node)
        if place is None:
            return Ruling()
        self._evidence.visited(place, visit)
        if self._may_fit_from_nearer(place):
            self._again = place
            self._looked_nearer.add(place)
            return Ruling(f"{visit.likeness:.0%} alike: a look from nearer by{self._evidence.told()}")
        return self._judge(place)

    def lost(self, node: int | None) -> Ruling:
        """The goal picture was not found where its place should be."""
        place = self._candidates.nearest(node)
        if place is None:
            return Ruling("not seen")
        self._losses[place] += 1
        if self._is_known(place) or self._losses[place] < TRIES:
            return Ruling("not seen")
        self._evidence.visited(place, Visit())
        return self._judge(place)

    def blocked(self, node: int | None) -> Ruling:
        """The last way to the goal is shut where its place should be: that excludes nothing."""
        place = self._candidates.nearest(node)
        if place is None:
            return Ruling("not reached")
        self._blocks[place] += 1
        if self._is_known(place) or self._blocks[place] < TRIES:
            return Ruling("not reached")
        if place not in self._evidence.visits:
            self._shut.add(place)
        return self._judge(place)

    def way_failed(self, waypoint: int) -> Ruling | None:
        """A way to one of a place's nodes failed: None while others are worth a try."""
        place = next((place for place in self._left() if waypoint in place.nodes), None)
        if self._candidates.plain or place is None:
            return None
        self._ways[place] += 1
        if self._ways[place] < WAYS_TRIED:
            return None
        self._shut.add(place)
        ruling = self._judge(place)
        return replace(ruling, why=f"{WAYS_TRIED} ways to node {place.nodes[0]} failed; {ruling.why}")

    def _open(self) -> list[Hypothesis]:
        """Places to go to: that to look at again, those not visited yet, or the best one."""
        if self._candidates.plain:
            return self._candidates.places
        again, best = [] if self._again is None else [self._again], self._evidence.best()
        return again + self._left() or ([] if best is None else [best])

    def _may_fit_from_nearer(self, place: Hypothesis) -> bool:
        """Whether a place differs by little more than a right one does: once, while others are left."""
        new = self._again is None and place not in self._looked_nearer
        return new and self._evidence.may_fit(place) and bool(self._left())

    def _left(self) -> list[Hypothesis]:
        """Places worth going to: one missed before, which differs more than another does, is none.

        None is where another is the goal's as surely as a visit would tell.
        """
        done = self._evidence.visits.keys() | self._shut | self._evidence.told_apart((+self._losses).keys())
        left = [place for place in self._candidates.places if place not in done]
        unseen, best = self._unseen([*left, *self._shut]), self._evidence.best()
        resembles = best is not None and self._evidence.visits[best].likeness >= SPOT_SHARE
        return [] if resembles and self._evidence.settled(self._known, unseen, EQUAL_RISK) else left

    def _unseen(self, places: Collection[Hypothesis]) -> int:
        """Of places that nobody saw those that may look like another one in everything."""
        return sum(place not in self._candidates.unlikely for place in places)

    def _is_known(self, place: Hypothesis) -> bool:
        return place in self._evidence.visits and place != self._again

    def _judge(self, here: Hypothesis) -> Ruling:
        visits, best, left = self._evidence.visits, self._evidence.best(), self._left()
        if left or here == self._again:
            self._again = None
        names = self._candidates.names
        if left:
            alike = f"{visits[here].likeness:.0%} alike; " if here in visits else ""
            told = self._evidence.told()
            return Ruling(f"{alike}{len(left)} places that look alike are not excluded{told}")
        most = visits[best].likeness if best is not None else 0.0
        risk = self._evidence.risk(self._known, self._unseen(self._shut))
        if self._shut and (most < SPOT_SHARE or risk > EQUAL_RISK):
            shut = [str(place.nodes[0]) for place in self._candidates.places if place in self._shut]
            why = f"of the places of nodes {names} that of {', '.join(shut)} could not be reached"
            return Ruling(why, "ambiguous" if most >= SPOT_SHARE else "blocked")
        if most < SPOT_SHARE and (best is None or not self._evidence.fits(best, self._known)):
            why = f"the goal resembles nodes {names}, but is at none of them, {most:.0%} alike at most"
            return Ruling(why, "goal_not_in_map")
        if self._evidence.rivals():
            why = f"one of the places of nodes {names}, which look alike"
            return Ruling(why + self._evidence.told(), self._look_again())
        if best != here:
            return Ruling(f"another place resembles the goal more, by {most:.0%}{self._evidence.told()}")
        self._learn()
        return Ruling()

    def _look_again(self) -> FailureKind:
        """Once the place that differs least is worth another look; what is in doubt after that stays so."""
        if not self._has_looked_again:
            self._has_looked_again, self._again = True, self._evidence.least_different()
        if self.looks_again:
            return ""
        self._learn()
        return "ambiguous"

    def _learn(self) -> None:
        """What this mission found out is of use to the next ones."""
        self._known.learn(*self._evidence.seen())
