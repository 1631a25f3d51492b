"""The thesis's heading methods 1 to 6 (chapter 2 and section 3.2.1) as one table, by name.

| method | sums | weighted by | equations |
|---|---|---|---|
| 1 | bisectors of all pairs of longitudes (after [34]) | | (2.1) to (2.7) |
| 2 | the same | how much the pair spread | (2.8) to (2.10) |
| 3 | longitude vectors of single matches, signed by their latitudes | | (2.11) to (2.16) |
| 4 | the same | how much the latitude grew | (2.17), (2.18) |
| 5 | methods 1 and 4 | | section 3.2.1 |
| 6 | methods 2 and 4 | | section 3.2.1 |
"""

from collections.abc import Callable
from functools import reduce
from typing import Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from services.planner.heading.estimate import HeadingEstimate, Resultant, weighted_sum
from services.planner.heading.histogram import method_by_histogram
from services.planner.heading.votes import Votes, latitude_votes, pair_votes
from services.planner.heading.weights import UNWEIGHTED, WeightSettings
from shared.geometry.sphere import FloatArray
from shared.geometry.two_view_types import checked_matches

MethodName = Literal["epipolar", "histogram", "1", "2", "3", "4", "5", "6"]
"""What a planner may be told to use: two-view geometry, the histogram's choice of 1 and 4, or one method."""
METHOD_NAMES: tuple[str, ...] = get_args(MethodName)
HISTOGRAM = "histogram"

Combination = Literal["raw", "unit"]
"""How methods 5 and 6 add their parts: as they are, or each scaled to length one (Q7, the thesis does not
say)."""


class Part(NamedTuple):
    """One sum of votes."""

    votes: Callable[[FloatArray, FloatArray], Votes]
    weighted: bool


METHODS: dict[str, tuple[Part, ...]] = {
    "1": (Part(pair_votes, weighted=False),),
    "2": (Part(pair_votes, weighted=True),),
    "3": (Part(latitude_votes, weighted=False),),
    "4": (Part(latitude_votes, weighted=True),),
    "5": (Part(pair_votes, weighted=False), Part(latitude_votes, weighted=True)),
    "6": (Part(pair_votes, weighted=True), Part(latitude_votes, weighted=True)),
}


def heading_vector(
    name: str,
    current: FloatArray,
    target: FloatArray,
    weight: WeightSettings | None = None,
    combination: Combination = "raw",
) -> Resultant:
    """The heading vector of a method.

    Args:
        name: a key of METHODS.
        current: (N, 2) longitude, latitude, current frame, radians.
        target: (N, 2) the same matches in the target frame.
        weight: weight function of the weighted sums; None for exp of degrees.
        combination: how methods 5 and 6 add their parts.
    """
    parts = [
        _sum(part.votes(current, target), weight or WeightSettings() if part.weighted else UNWEIGHTED)
        for part in METHODS[name]
    ]
    if len(parts) > 1 and combination == "unit":
        parts = [part.unit() for part in parts]
    return reduce(Resultant.__add__, parts)


def heading_estimate(
    name: str,
    current: npt.ArrayLike,
    target: npt.ArrayLike,
    weight: WeightSettings | None = None,
    combination: Combination = "raw",
) -> HeadingEstimate:
    """Heading and strength by a method, from matches.

    Pass verified ones: a steep weight lets one wrong match decide.

    Args:
        name: a key of METHODS, or "histogram" for method 1 or 4 by where the matches lie.
        current: (N, 2) longitude, latitude, current frame, radians.
        target: (N, 2) the same matches in the target frame.
        weight: weight function of methods 2, 4, 5 and 6; None for exp of degrees.
        combination: how methods 5 and 6 add their parts.

    Raises:
        ValueError: unknown method, or arrays of different shapes.
    """
    if name not in (HISTOGRAM, *METHODS):
        raise ValueError(f"unknown heading method {name!r}, choose one of {', '.join((HISTOGRAM, *METHODS))}")
    c, t = checked_matches(np.reshape(current, (-1, 2)), np.reshape(target, (-1, 2)))
    method = method_by_histogram(c) if name == HISTOGRAM else name
    return heading_vector(method, c, t, weight, combination).estimate()


def _sum(votes: Votes, weight: WeightSettings) -> Resultant:
    return weighted_sum(votes.directions, weight.log_weights(votes.growth_rad))
