"""What the visits of earlier missions say of how often rooms of this map look alike in everything. Pure."""

import math
from collections.abc import Collection
from dataclasses import dataclass, field


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

    def risk(self, unseen: int) -> float:
        """Chance that a goal is at one of some places that nobody saw, though another one fits it.

        It is there only if that place looks like the other one in everything, and then as likely as not. How
        many of a building's places do is what the visits say (Laplace's rule of succession).
        """
        return unseen / 2 * (self.equal + 1) / (len(self.told) + self.equal + 2)

    @property
    def least_told(self) -> float:
        """The least that any place differed that was told from the right one; 0 where that is unknown."""
        return min(filter(math.isfinite, self.told), default=0.0)
