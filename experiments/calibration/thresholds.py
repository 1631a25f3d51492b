"""From measured pairs to thresholds of similarity. Pure.

The thesis found 80 and 110 of 150 for its own pipeline by trial. Here the same questions are asked of
measured pairs: below which S can a bearing not be trusted, and how similar are frames as far apart as
nodes should be?
"""

import math
import statistics
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from experiments.rendered.tables import BINS_M
from services.launcher.client.environments import Spans
from services.launcher.client.failure import ExperimentError
from services.launcher.terminal.output import rounded
from shared.mapgraph.local.view_range import ROOM_HALF_M, half_told_m

WRONG_RAD = math.radians(20.0)
"""As far as the bearing of an edge may be off (services/launcher/evaluation/map_quality.py)."""

SAFETY = 1.333
"""The thesis's safety factor of the map thresholds over those of driving (section 6.1: 60 becomes 80)."""

DOUBTFUL_SHARE = 0.05
"""Of bearings that people placed by hand or that commands tell so many may be wrong themselves: of 109 sure
answers about photographs three differ by 170 degrees, with 93 to 188 matches."""

BLOCKED_SHARE = 0.05
"""Of edges so many may lead past something: of paths of ten, six in ten then have no such edge."""

EDGE_TO_NODE = 80 / 110
"""The thesis's threshold of an edge to that of a new node (section 6.1): nodes that follow each other have an
edge."""

AT_VIA_PERCENT = 90.0
"""Of the frames near enough to a via point so many are not near enough to a goal."""

MIN_VIA = 15
"""Just below the least that any profile of services/planner/profiles.py was measured to need (16)."""


@dataclass(frozen=True)
class Pair:
    """Two pictures, and what a pipeline made of them.

    Attributes:
        similarity: S as the rules count it: matches that agree with one motion, or all.
        error_rad: of the bearing, None without an answer.
        distance_m: between the two; None where nobody knows.
        is_free: a robot can drive straight from one to the other, as far as is known.
    """

    similarity: int
    error_rad: float | None
    distance_m: float | None = None
    is_free: bool = True

    @property
    def is_wrong(self) -> bool:
        """Whether it would mislead."""
        return self.error_rad is not None and self.error_rad > WRONG_RAD

    def is_within(self, low_m: float, high_m: float) -> bool:
        """Whether the two are known to be so far apart."""
        return self.distance_m is not None and low_m <= self.distance_m < high_m


def propose(
    pairs: Sequence[Pair], spans: Spans, *, doubtful: bool = False, look_alikes: Sequence[int] = ()
) -> dict[str, float]:
    """Thresholds for `services.planner.profiles`, as these pairs count S.

    Args:
        pairs: what was measured.
        spans: distances between nodes.
        doubtful: the bearings known may be wrong themselves.
        look_alikes: verified matches of pairs of different places that nothing else keeps from an edge.

    Returns:
        s_via_min: no bearing of a pair with more was wrong by 20 degrees, or one in 20 of the doubtful ones;
            at least MIN_VIA.
        s_edge_min: the same times the thesis's safety factor, and above all look-alikes.
        s_node_max: median between frames as far apart as nodes should be.
        s_via_max: median between frames nearer than a reached via point.
        The last two are left out where nobody knows distances.

    Raises:
        ExperimentError: no pair at those distances; measure more.
    """
    answers = [pair for pair in pairs if pair.error_rad is not None]
    wrong_share = DOUBTFUL_SHARE if doubtful else 0.0
    s_via_min = max(MIN_VIA, _floor(answers, lambda pair: pair.is_wrong, wrong_share))
    s_edge_min = max(math.ceil(SAFETY * s_via_min), max(look_alikes, default=0) + 1)
    found: dict[str, float] = {"s_via_min": s_via_min, "s_edge_min": s_edge_min}
    if all(pair.distance_m is None for pair in pairs):
        return found
    return {
        **found,
        "s_node_max": _median_within(pairs, *spans.node_m),
        "s_via_max": _median_within(pairs, 0.0, spans.near_m),
    }


def propose_by_count(pairs: Sequence[Pair], spans: Spans, keypoints: int) -> dict[str, float]:
    """The same for rules that know the end of a path and slow down by S alone, as the thesis's do.

    Args:
        pairs: what was measured.
        spans: distances between nodes.
        keypoints: of a picture: S of two equal ones.

    Returns:
        What `propose` returns, and
        s_edge_min: as there, but of pairs with more one in 20 leads past something at most: to these rules
            an edge is a free way. No more than that nodes that follow each other still have one.
        s_final: no frame between a reached via point and the next node has more, and of frames at a via point
            one in ten: there are many frames on the last metre, and none is to end the round too early.
        s_slow, s_max: of the velocity law: slower from a reached via point on, as in the thesis (6.1.5).
    """
    found = propose(pairs, spans)
    almost = [pair.similarity for pair in pairs if pair.is_within(spans.near_m, spans.node_m[1])]
    at_via = [pair.similarity for pair in pairs if pair.is_within(0.0, spans.near_m)]
    s_final = max(*almost, math.ceil(float(np.percentile(at_via, AT_VIA_PERCENT))))
    free = min(
        _floor(pairs, lambda pair: not pair.is_free, BLOCKED_SHARE),
        math.floor(EDGE_TO_NODE * found["s_node_max"]),
    )
    s_edge_min = max(found["s_edge_min"], free)
    return {
        **found,
        "s_edge_min": s_edge_min,
        "s_final": s_final,
        "s_slow": found["s_via_max"],
        "s_max": keypoints,
    }


def longest_edge_m(pairs: Sequence[Pair], spans: Spans, keypoints: int, bound_m: float) -> float:
    """The bound on edges in a room, for a pipeline whose views carry as far as in these pairs of one.

    In a hall edges may be longer, by as much as views carry further there than the default pipeline's do in a
    room: a pipeline that sees further takes the room for a hall, and views past corners for edges.

    Args:
        pairs: of verified matches, in a room.
        spans: distances between nodes.
        keypoints: of a picture.
        bound_m: for the default pipeline; 0 is none.
    """
    near = [pair for pair in pairs if pair.is_within(*spans.node_m)]
    carries = [half_told_m(pair.distance_m or 0.0, pair.similarity, keypoints) for pair in near]
    return round(bound_m * min(1.0, ROOM_HALF_M / statistics.median(carries)), 2)


def distance_rows(pairs: Sequence[Pair]) -> list[dict[str, float | str]]:
    """One row per bin of distance, for those that are known; S counts verified matches."""
    rows: list[dict[str, float | str]] = []
    for low_m, high_m in pairwise(BINS_M):
        inside = [pair for pair in pairs if pair.is_within(low_m, high_m)]
        if inside:
            verified = rounded(np.median([pair.similarity for pair in inside]), 1)
            wrong = sum(pair.is_wrong for pair in inside)
            of = {"pairs": len(inside), "verified": verified, "wrong": wrong}
            rows.append({"distance_m": f"{low_m:g}-{high_m:g}", **of})
    return rows


def _floor(pairs: Sequence[Pair], is_bad: Callable[[Pair], bool], share: float) -> int:
    """The least number of matches above which at most such a share of the pairs is bad."""
    for floor in sorted({0, *(pair.similarity for pair in pairs)}):
        above = [is_bad(pair) for pair in pairs if pair.similarity > floor]
        if sum(above) <= share * len(above):
            return floor
    return 0


def _median_within(pairs: Sequence[Pair], low_m: float, high_m: float) -> int:
    inside = [pair.similarity for pair in pairs if pair.is_within(low_m, high_m)]
    if not inside:
        raise ExperimentError(
            f"expected pairs of pictures between {low_m} and {high_m} m apart, got none: measure more pairs "
            "(--pairs)"
        )
    return round(float(np.median(inside)))
