"""Candidates that others support: the shortest cycles through two of them, back to the start. Pure.

The rule is the one by which exploration closes loops (`shared.mapgraph.cycle_consistency`): a neighbour of
the node in question must fit as well. Between two maps there are three such cycles:

    one node of `other`, two neighbours of `base`     a triangle
    one node of `base`, two neighbours of `other`     a triangle
    two neighbours of each                            four sides

An aliased view gives a motion of its own, and its cycles with the nodes beside do not close; those that could
be judged and do not close speak against it, with as many inliers as they have.
"""

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

from shared.mapgraph.cycle_consistency import outvoted
from shared.mapgraph.merging.candidates import Candidate
from shared.mapgraph.merging.sight_graph import SightGraph
from shared.mapgraph.triangle import DIRECTION_RAD, YAW_RAD, Sight, apart_rad, triangle_closes

Votes = Mapping[Candidate, Mapping[Candidate, int]]
"""For each candidate those that can judge it: their inliers, negative where the cycle does not close."""


def votes_among(base: SightGraph, other: SightGraph, candidates: Sequence[Candidate]) -> Votes:
    """Let all pairs of candidates that are neighbours in both maps judge one another."""
    at: dict[int, list[Candidate]] = {}
    for candidate in candidates:
        at.setdefault(candidate.other, []).append(candidate)
    votes: dict[Candidate, dict[Candidate, int]] = {candidate: {} for candidate in candidates}
    for first in candidates:
        for second in _beside(other, at, first):
            if second not in votes[first] and (closes := _judge(base, other, first, second)) is not None:
                sign = 1 if closes else -1
                votes[first][second] = sign * second.match.inliers
                votes[second][first] = sign * first.match.inliers
    return votes


def supported(votes: Votes, among: Iterable[Candidate]) -> set[Candidate]:
    """Those of `among` that somebody supports and no majority contradicts, weakest dropped first."""
    kept = set(among)
    judged = {one: {by: vote for by, vote in votes[one].items() if by in kept} for one in kept}
    return kept - outvoted(judged, least=1, order=lambda one: (one.other, one.base)).keys()


def cycle_closes(legs: Sequence[Sight]) -> bool:
    """Whether the yaws round a cycle add up and its bearings can lead back to where it began.

    Bearings can: unless they all point into one half of the circle, some lengths of the legs close the cycle.

    Args:
        legs: each node as seen from the one before, the last one being the first again. A leg without a
            bearing has no length.
    """
    yaw_rad, bearings = 0.0, []
    for leg in legs:
        if leg.heading_rad is not None:
            bearings.append((yaw_rad + leg.heading_rad) % math.tau)
        yaw_rad += leg.yaw_rad if leg.yaw_rad is not None else math.inf
    if not math.isfinite(yaw_rad) or apart_rad(yaw_rad, 0.0) > yaw_error_rad(len(legs)):
        return False
    bearings.sort()
    gaps = [after - before for before, after in itertools.pairwise(bearings)]
    return not bearings or max([*gaps, bearings[0] + math.tau - bearings[-1]]) < math.pi + DIRECTION_RAD


def yaw_error_rad(legs: int) -> float:
    """How much the yaws round a cycle of so many legs may miss a full circle.

    A triangle's is measured; it grows with the root of the number of legs, as a random walk does.
    """
    return YAW_RAD * math.sqrt(max(legs, 3) / 3.0)


def _beside(other: SightGraph, at: Mapping[int, list[Candidate]], first: Candidate) -> Iterator[Candidate]:
    """Candidates at the same node of the other map or at a neighbour of it."""
    for node in (first.other, *other.sights[first.other]):
        yield from at.get(node, ())


def _judge(base: SightGraph, other: SightGraph, first: Candidate, second: Candidate) -> bool | None:
    """Whether the cycle through both closes; None when there is no short one."""
    along_base = base.sights[first.base].get(second.base)
    along_other = other.sights[first.other].get(second.other)
    if first.other == second.other:
        return None if along_base is None else triangle_closes(first.sight, second.sight, along_base)
    if first.base == second.base:
        return None if along_other is None else triangle_closes(first.back, second.back, along_other)
    if along_base is None or along_other is None:
        return None
    home = other.sights[second.other][first.other]
    legs = [first.sight, along_base, second.back, home]
    if along_base.heading_rad is None or home.heading_rad is None:
        legs = [leg._replace(heading_rad=None) for leg in legs]  # only the yaws can be judged
    return cycle_closes(legs)
