"""One way to lay a map over another: the largest set of matches that do not contradict one another. Pure.

Cycles of three or four sides cannot tell a whole street from an equal one elsewhere: in both all of them
close. But then the same nodes of one map would be at two spots of the other that lie far apart, or turned
another way. Every match fixes how one map's cameras are turned against the other's, through the chains of
edges to any other match; and as the thesis would connect a frame only with a limited range of nodes
(section 6.1.1, a sliding window), nodes near one another in one map must be near one another in the other.
"""

from collections.abc import Sequence, Set

from shared.mapgraph.merging.candidates import Candidate, MergeRefusedError
from shared.mapgraph.merging.sight_graph import SightGraph
from shared.mapgraph.merging.votes import Votes, yaw_error_rad
from shared.mapgraph.triangle import apart_rad

WINDOW_HOPS = 3
"""Edges by which two chains between the same nodes may differ, beside one being twice as long: beyond it
perceptual aliasing begins (58 of 153 such edges in a village of equal houses were wrong)."""

ANCHORS = 64
"""Matches of the largest set that judge all others. Each needs chains from both its ends: 1.5 s in all in
grids of 10,000 nodes (12 ms a search)."""

SECOND_SHARE = 0.5
"""A second way to lay the maps over one another with more than this share of the matches of the first one
leaves it open which is true. Chosen: the true one must have twice as many."""


def groups_of(votes: Votes, among: Set[Candidate]) -> list[list[Candidate]]:
    """Sets of candidates held together by agreement, largest first, then by inliers."""
    groups, seen = [], set()
    for first in sorted(among, key=_order):
        if first in seen:
            continue
        seen.add(first)
        group = [first]
        for one in group:  # grows while it is read
            joined = [v for v, vote in votes[one].items() if vote > 0 and v in among and v not in seen]
            seen.update(joined)
            group += joined
        groups.append(sorted(group, key=_order))
    return sorted(groups, key=lambda g: (len(g), sum(one.match.inliers for one in g)), reverse=True)


def largest_overlay(
    base: SightGraph, other: SightGraph, groups: Sequence[Sequence[Candidate]]
) -> set[Candidate]:
    """The matches that the largest group and the chains from it do not contradict.

    Args:
        base: the map that grows.
        other: the map whose nodes it gets.
        groups: matches that hold together, the largest group first; at least one.

    Raises:
        MergeRefusedError: another group, which contradicts it, is nearly as large.
    """
    judges = [_Judge(base, other, anchor) for anchor in _spread(groups[0])]
    kept = {one for group in groups for one in group if sum(judge.vote(one) for judge in judges) >= 0.0}
    second = max((len(set(group) - kept) for group in groups[1:]), default=0)
    if second > SECOND_SHARE * len(kept):
        raise MergeRefusedError(
            f"the maps fit in two ways, which cannot both be true: {len(kept)} nodes that look alike speak "
            f"for one and {second} for the other"
        )
    return kept


class _Judge:
    """One match that is taken for true, and what it says of others."""

    def __init__(self, base: SightGraph, other: SightGraph, anchor: Candidate) -> None:
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
        yaws_fit = apart_rad(round_rad, 0.0) <= yaw_error_rad(near + far + 2)
        return weight if yaws_fit and far <= 2 * near + WINDOW_HOPS else -weight


def _spread(group: Sequence[Candidate]) -> list[Candidate]:
    """At most ANCHORS of them, evenly spread."""
    step = max(1, -(-len(group) // ANCHORS))
    return list(group[::step])


def _order(one: Candidate) -> tuple[int, int]:
    return one.other, one.base
