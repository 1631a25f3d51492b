"""One way to lay a map over another: the largest set of matches that do not contradict one another. Pure.

Loops of three or four sides cannot tell a whole street from an equal one elsewhere: in both all of them
close. But then the same places of one map would be at two places of the other that lie far apart, or turned
another way. Every match fixes how one map's cameras are turned against the other's, through the chains of
connections to any other match; and as the thesis would connect a frame only with a limited range of places
(section 6.1.1, a sliding window), places near one another in one map must be near one another in the other.
"""

from collections.abc import Sequence, Set

from services.gateway.merging.core.candidates import Candidate, MergeRefusedError
from services.gateway.merging.core.places import Places
from services.gateway.merging.core.witnesses import Votes, turn_error_rad
from shared.mapgraph.triangle import apart_rad

WINDOW_HOPS = 3
"""Connections by which two chains between the same places may differ, beside one being twice as long."""

ANCHORS = 64
"""Matches of the largest set that judge all others; more would cost time and say the same."""

RIVAL_SHARE = 0.5
"""A second way to lay the maps over one another with more than this share of the matches of the first one
leaves it open which is true."""


def groups_of(votes: Votes, witnessed: Set[Candidate]) -> list[list[Candidate]]:
    """Sets of candidates held together by agreement, largest first, then by verified matches."""
    groups, seen = [], set()
    for first in sorted(witnessed, key=_order):
        if first in seen:
            continue
        seen.add(first)
        group = [first]
        for one in group:  # grows while it is read
            joined = [v for v, agree in votes[one].items() if agree and v in witnessed and v not in seen]
            seen.update(joined)
            group += joined
        groups.append(sorted(group, key=_order))
    return sorted(groups, key=lambda g: (len(g), sum(one.match.inliers for one in g)), reverse=True)


def largest_overlay(base: Places, other: Places, groups: Sequence[Sequence[Candidate]]) -> set[Candidate]:
    """The matches that the largest group and the chains from it do not contradict.

    Args:
        base: the map that grows.
        other: the map whose places it gets.
        groups: matches that hold together, the largest group first; at least one.

    Raises:
        MergeRefusedError: a rival group is nearly as large.
    """
    judges = [_Judge(base, other, anchor) for anchor in _spread(groups[0])]
    kept = {one for group in groups for one in group if sum(judge.vote(one) for judge in judges) >= 0.0}
    rival = max((len(set(group) - kept) for group in groups[1:]), default=0)
    if rival > RIVAL_SHARE * len(kept):
        raise MergeRefusedError(
            f"the maps fit in two ways, which cannot both be true: {len(kept)} places that look alike speak "
            f"for one and {rival} for the other"
        )
    return kept


class _Judge:
    """One match that is taken for true, and what it says of others."""

    def __init__(self, base: Places, other: Places, anchor: Candidate) -> None:
        self._anchor = anchor
        self._base, self._other = base.chains(anchor.base), other.chains(anchor.other)

    def vote(self, one: Candidate) -> float:
        """Positive for, negative against `one`; the nearer, the more it counts. 0 where no chain leads."""
        in_base, in_other = self._base.get(one.base), self._other.get(one.other)
        if one is self._anchor or in_base is None or in_other is None:
            return 0.0
        near, far = sorted((in_base.hops, in_other.hops))
        weight = 1.0 / (1 + near) ** 2
        round_rad = self._anchor.yaw_rad + in_base.yaw_rad - one.yaw_rad - in_other.yaw_rad
        turns_fit = apart_rad(round_rad, 0.0) <= turn_error_rad(near + far + 2)
        return weight if turns_fit and far <= 2 * near + WINDOW_HOPS else -weight


def _spread(group: Sequence[Candidate]) -> list[Candidate]:
    """At most ANCHORS of them, evenly spread."""
    step = max(1, -(-len(group) // ANCHORS))
    return list(group[::step])


def _order(one: Candidate) -> tuple[int, int]:
    return one.other, one.base
