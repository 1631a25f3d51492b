"""What the visits of earlier missions say of how often rooms of this map look alike in everything. Pure."""

import math
from collections.abc import Collection
from dataclasses import dataclass, field

EQUAL_BEFORE, TOLD_BEFORE = 1, 12
"""Rooms furnished alike that nothing tells apart, and those that something does, as if they had been visited
before: of 1,364 pairs of rooms in 45 hostels and hotels of development 102 have the same small things, as one
in 13. It weighs no more than one room that is equal."""
FITS_LEVELS = 7.0
"""Most that a place differs that fits. From 1 to 5 cm beside a spot 130 of 138 right rooms of three hostels
and three hotels of development differ by less, 396 other rooms by 9.9 and more, 30 at the median."""
MAY_FIT_LEVELS = 14.0
"""Most that a right place differs where the robot arrives; chosen: of 14 spots of a hotel of development seen
from 4.5 cm aside 11 fit, and the others differ by 7.2 to 10.3; from 3 cm 13 fit."""
SETTLED_FACTOR = 2.0
"""Where others differ by little it fits by so many times less than all that were told from right ones: two
looks at rooms that nothing tells apart are 1.9 times apart at most."""


@dataclass
class LookAlikes:
    """Of places that resembled a goal picture, by how much those differed that were not it.

    Attributes:
        told: differences of each place that was told from the right one, in levels; infinite where matches
            alone told it.
        equal: places that nothing told from it.
    """

    told: list[float] = field(default_factory=list)
    equal: int = 0

    def learn(self, told: Collection[float], equal: int) -> None:
        """What one mission found out."""
        self.told += told
        self.equal += equal

    def with_more(self, told: Collection[float], equal: int) -> "LookAlikes":
        """This and what the mission under way has found out."""
        return LookAlikes([*self.told, *told], self.equal + equal)

    def risk(self, unseen: int, *, fits: bool = True) -> float:
        """Chance that a goal is at one of some places that nobody saw, though another one looks like it.

        It is there only if that place looks like the other one in everything, and then as likely as not. How
        many of a building's places do is what the visits say (Laplace's rule of succession). What those of
        other buildings say is of places that fit.

        Args:
            unseen: how many there are.
            fits: whether the other one does, see `fits`.
        """
        equal = self.equal + EQUAL_BEFORE
        told = len(self.told) + (TOLD_BEFORE if fits else 1)
        return unseen / 2 * equal / (told + equal)

    def fits(self, differs: float) -> bool:
        """Whether a place differs from the goal as little as a right one does, in levels."""
        return differs <= FITS_LEVELS and SETTLED_FACTOR * differs <= min(self.told, default=math.inf)
