"""What was seen at places that look alike, and what it says of which of them it is. Pure."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

from services.planner.goals.picture_levels import largest, levels
from services.planner.look_alikes import FITS_LEVELS, MAY_FIT_LEVELS, LookAlikes
from shared.mapgraph.local.hypotheses import Hypothesis
from shared.messages.arrays import Array

EXCLUDED_SHARE = 0.7
"""A place that resembles the goal by less than this share of the best one is excluded. Rooms furnished alike
but for a few small things have 0.85 and more: they exclude nothing."""
TOLD_FACTOR = 3.0
"""A place from which the goal differs as a picture by so much more than from another is excluded. Of 36 pairs
of rooms that a few small things tell apart, each seen from 1 to 6 cm aside, it excludes all, also where
somebody stands in the goal picture, and 33 where the right one is seen from 10 cm. 12 that nothing tells
apart come to 1.6 at most (from 1 to 10 cm); with somebody in the picture one of them to 3.4, others to 2."""


@dataclass(frozen=True, order=True)
class Visit:
    """How the goal resembled the view at a place.

    Attributes:
        similarity: S of the two; places are compared by it.
        likeness: as a share of that of two frames in a row, which noise and light lower as well.
    """

    similarity: int = 0
    likeness: float = 0.0


class PlaceEvidence:
    """Visits, and how much the goal picture differed from what was seen there, the least of all frames.

    Attributes:
        visits: the best one of each place; one in vain has nothing in common.
    """

    def __init__(self) -> None:
        self.visits: dict[Hypothesis, Visit] = {}
        self._looks: dict[Hypothesis, Array] = {}
        self._differs: dict[Hypothesis, float] | None = None  # of these looks, as each frame asks for it

    def visited(self, place: Hypothesis, visit: Visit) -> None:
        """The robot stood there."""
        self.visits[place] = max(visit, self.visits.get(place, Visit()))

    def looked(self, place: Hypothesis, differences: Array) -> None:
        """A frame was taken beside where the goal picture should have been.

        Args:
            place: where it was taken.
            differences: `NodeMatch.differences` of the frame and the goal.
        """
        if place not in self._looks or largest(differences) < largest(self._looks[place]):
            self._looks[place], self._differs = differences, None

    def best(self) -> Hypothesis | None:
        """The place visited that resembles the goal most, of those that do not differ from it too much."""
        return max(self._alive(), key=lambda place: self.visits[place], default=None)

    def rivals(self) -> list[Hypothesis]:
        """Places visited that may be it as well as the best one: as much like it, or less different."""
        best = self.best()
        if best is None:
            return []
        least, differs = EXCLUDED_SHARE * self.visits[best].similarity, self._differ()
        most = differs.get(best, math.inf)
        return [
            place
            for place in self._alive()
            if place != best
            and (self.visits[place].similarity >= least or differs.get(place, math.inf) < most)
        ]

    def least_different(self) -> Hypothesis | None:
        """The place from which the goal differs least as a picture; None where that is known of none."""
        differs = self._differ()
        return min(differs, key=lambda place: differs[place], default=None)

    def seen(self) -> tuple[list[float], int]:
        """By how much each place differs that was told from the best one, and how many were not.

        One that matches alone told differs infinitely: what it differs by tells nothing.
        """
        rivals, differs = self.rivals(), self._differ()
        told, most = self.visits.keys() - {self.best(), *rivals}, self._most(differs)
        return [differs.get(p, 0.0) if differs.get(p, 0.0) >= most else math.inf for p in told], len(rivals)

    def risk(self, known: LookAlikes, unseen: int) -> float:
        """Chance that the goal is at one of some places that nobody saw and not at the best one, if any.

        Args:
            known: of this map, by earlier missions.
            unseen: how many places there are that nobody saw.
        """
        seen, best = known.with_more(*self.seen()), self.best()
        return seen.risk(unseen, fits=best is None or self.fits(best, seen))

    def settled(self, known: LookAlikes, unseen: int, most: float) -> bool:
        """Whether a place visited is the goal's, whatever nobody saw looks like: it fits, and no other does.

        Args:
            known: of this map, by earlier missions.
            unseen: places that nobody saw.
            most: accepted chance that one of them is as much like the goal.
        """
        best, (told, equal) = self.best(), self.seen()
        seen = known.with_more(told, equal)
        return best is not None and not equal and self.fits(best, seen) and seen.risk(unseen) <= most

    def fits(self, place: Hypothesis, known: LookAlikes) -> bool:
        """Whether the goal differs from a place as little as from the right one."""
        return known.fits(self._differ().get(place, math.inf))

    def may_fit(self, place: Hypothesis) -> bool:
        """Whether it differs by more than a right place does from 3 cm, but by no more than some from 5."""
        return FITS_LEVELS < self._differ().get(place, math.inf) <= MAY_FIT_LEVELS

    def told(self) -> str:
        """How much the goal differs at each place where that is known, for people, to end a sentence with."""
        known = sorted((differs, place.nodes[0]) for place, differs in self._differ().items())
        told = ", ".join(f"{node}: {differs:.0f}" for differs, node in known)
        return f"; differences: {told}" if told else ""

    def told_apart(self, places: Collection[Hypothesis]) -> set[Hypothesis]:
        """Of some places, seen but never stood at, those that differ too much beside one that was visited."""
        if not places:
            return set()
        differs = self._differ()
        most = self._most(differs)
        return {place for place in places if most <= differs.get(place, 0.0)}

    def _most(self, differs: Mapping[Hypothesis, float]) -> float:
        """From so much on a place differs too much: a multiple of the least at any that was visited."""
        return TOLD_FACTOR * min((differs.get(place, math.inf) for place in self.visits), default=math.inf)

    def _alive(self) -> list[Hypothesis]:
        differs = self._differ()
        most = self._most(differs)
        return [place for place in self.visits if differs.get(place, 0.0) < most or math.isinf(most)]

    def _differ(self) -> dict[Hypothesis, float]:
        """By how much the goal differs from each place, but for what differs at all of them."""
        if self._differs is None:
            self._differs = levels(self._looks)
        return self._differs
