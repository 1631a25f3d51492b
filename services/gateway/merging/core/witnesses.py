"""Candidates that others bear out: the shortest loops through two of them, back to the start. Pure.

The rule is the one by which exploration closes loops (`shared/mapgraph/cycle_consistency.py`): a neighbour of
the place that is claimed must fit as well. Between two maps there are three such loops:

    one place of `other`, two neighbours of `base`     a triangle
    one place of `base`, two neighbours of `other`     a triangle
    two neighbours of each                             four sides

A view that resembles a wrong house gives a motion of its own, and its loops with the houses beside it do not
close; those that could be judged and do not close speak against it, with as many matches as they have.
"""

import itertools
import math
from collections.abc import Iterable, Iterator, Mapping, Sequence

from services.gateway.merging.core.candidates import Candidate
from services.gateway.merging.core.places import Places
from shared.mapgraph.triangle import DIRECTION_RAD, YAW_RAD, Sight, apart_rad, triangle_closes

Votes = Mapping[Candidate, Mapping[Candidate, bool]]
"""For each candidate those that can judge it, and whether they agree."""


def votes_among(base: Places, other: Places, candidates: Sequence[Candidate]) -> Votes:
    """Let all pairs of candidates that are neighbours in both maps judge one another."""
    at: dict[int, list[Candidate]] = {}
    for candidate in candidates:
        at.setdefault(candidate.other, []).append(candidate)
    votes: dict[Candidate, dict[Candidate, bool]] = {candidate: {} for candidate in candidates}
    for first in candidates:
        for second in _beside(other, at, first):
            if second not in votes[first] and (agree := _judge(base, other, first, second)) is not None:
                votes[first][second] = votes[second][first] = agree
    return votes


def borne_out(votes: Votes, among: Iterable[Candidate]) -> set[Candidate]:
    """Those of `among` with a witness that agrees and without a majority against them, weakest dropped first.

    Votes weigh the verified matches of the voter.
    """
    kept = set(among)
    balance = {
        one: sum(_weight(voter, votes[one][voter]) for voter in votes[one].keys() & kept) for one in kept
    }
    while balance:
        worst = min(balance, key=lambda one: (balance[one], one.other, one.base))
        if balance.pop(worst) > 0:
            break
        kept.remove(worst)
        for other, agree in votes[worst].items():
            if other in balance:
                balance[other] -= _weight(worst, agree)
    return kept


def loop_closes(legs: Sequence[Sight]) -> bool:
    """Whether the turns round a loop add up and its directions can lead back to where it began.

    Directions can: unless they all point into one half of the circle, some lengths of the legs close the
    loop. The error allowed in the turns grows with their number as that of a random walk.

    Args:
        legs: each place as seen from the one before, the last one being the first again. A leg without a
            direction has no length.
    """
    turned_rad, directions = 0.0, []
    for leg in legs:
        if leg.heading_rad is not None:
            directions.append((turned_rad + leg.heading_rad) % math.tau)
        turned_rad += leg.yaw_rad if leg.yaw_rad is not None else math.inf
    if not math.isfinite(turned_rad) or apart_rad(turned_rad, 0.0) > turn_error_rad(len(legs)):
        return False
    directions.sort()
    gaps = [after - before for before, after in itertools.pairwise(directions)]
    return not directions or max([*gaps, directions[0] + math.tau - directions[-1]]) < math.pi + DIRECTION_RAD


def turn_error_rad(legs: int) -> float:
    """How much the turns round a loop of so many legs may miss a full circle; a triangle's is measured."""
    return YAW_RAD * math.sqrt(max(legs, 3) / 3.0)


def _weight(voter: Candidate, agree: bool) -> int:
    return voter.match.inliers if agree else -voter.match.inliers


def _beside(other: Places, at: Mapping[int, list[Candidate]], first: Candidate) -> Iterator[Candidate]:
    """Candidates at the same place of the other map or at a neighbour of it."""
    for place in (first.other, *other.neighbours(first.other)):
        yield from at.get(place, ())


def _judge(base: Places, other: Places, first: Candidate, second: Candidate) -> bool | None:
    """Whether the loop through both closes; None when there is no short one."""
    along_base = base.neighbours(first.base).get(second.base)
    along_other = other.neighbours(first.other).get(second.other)
    if first.other == second.other:
        return None if along_base is None else triangle_closes(first.sight, second.sight, along_base)
    if first.base == second.base:
        return None if along_other is None else triangle_closes(first.back, second.back, along_other)
    if along_base is None or along_other is None:
        return None
    home = other.neighbours(second.other)[first.other]
    legs = [first.sight, along_base, second.back, home]
    if along_base.heading_rad is None or home.heading_rad is None:
        legs = [leg._replace(heading_rad=None) for leg in legs]  # only the turns can be judged
    return loop_closes(legs)
