"""How methods 5 and 6 add two heading vectors (Q7: raw by default, the thesis does not say)."""

from typing import Literal

from services.planner.heading.estimate import Resultant

Combination = Literal["raw", "unit"]


def combine(a: Resultant, b: Resultant, combination: Combination) -> Resultant:
    """Sum of two heading vectors: as they are, or each scaled to length one first."""
    return a + b if combination == "raw" else a.unit() + b.unit()
