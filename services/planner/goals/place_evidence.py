"""What was seen at places that look alike, and what it says of which of them it is. Pure."""

import math
from dataclasses import dataclass

from shared.mapgraph.local.hypotheses import Hypothesis

EXCLUDED_SHARE = 0.7
"""A place that resembles the goal by less than this share of the best one is excluded. Rooms furnished alike
but for a few small things have 0.85 and more: they exclude nothing."""
TOLD_FACTOR = 2.5
"""A place from which the goal differs as a picture by so much more than from another is excluded. Of 36 pairs
of rooms that a few small things tell apart, each seen from 1 to 5 cm aside, it excludes all, 32 where the
right one is seen from 10 cm. Of 12 that nothing tells apart it excludes none from 1 to 5 cm, where the factor
is 1.9 at most, and 2 right ones seen from 10 cm beside a wrong one from less; 3.0 would exclude as many."""


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
        self._difference: dict[Hypothesis, float] = {}

    def visited(self, place: Hypothesis, visit: Visit) -> None:
        """The robot stood there."""
        self.visits[place] = max(visit, self.visits.get(place, Visit()))

    def looked(self, place: Hypothesis, difference: float) -> None:
        """A frame was taken beside where the goal picture should have been."""
        self._difference[place] = min(difference, self._differs(place))

    def best(self) -> Hypothesis | None:
        """The place visited that resembles the goal most, of those that do not differ from it too much."""
        return max(self._alive(), key=lambda place: self.visits[place], default=None)

    def rivals(self) -> list[Hypothesis]:
        """Places visited that may be it as well as the best one: as much like it, or less different."""
        best = self.best()
        if best is None:
            return []
        least = EXCLUDED_SHARE * self.visits[best].similarity
        return [
            place
            for place in self._alive()
            if place != best
            and (self.visits[place].similarity >= least or self._differs(place) < self._differs(best))
        ]

    def least_different(self) -> Hypothesis | None:
        """The place from which the goal differs least as a picture; None where that is known of none."""
        return min(self._difference, key=self._differs, default=None)

    def told(self) -> str:
        """How much the goal differs at each place where that is known, for people."""
        known = sorted((differs, place.nodes[0]) for place, differs in self._difference.items())
        return ", ".join(f"{node}: {differs:.0f}" for differs, node in known)

    def _alive(self) -> list[Hypothesis]:
        least = min((self._differs(place) for place in self.visits), default=math.inf)
        most = TOLD_FACTOR * least
        return [place for place in self.visits if self._difference.get(place, 0.0) < most or math.isinf(most)]

    def _differs(self, place: Hypothesis) -> float:
        return self._difference.get(place, math.inf)
