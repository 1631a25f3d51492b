"""The matches between two maps that may become edges. Pure.

A match is accepted when it can be trusted by itself (`candidates`), when a neighbour supports it and no
majority of neighbours contradicts it (`votes`), when the matches that hold together with it were made from
nearby, and when all of them belong to the largest set that can be true at once (`overlay`).
"""

from collections.abc import Collection, Iterable, Mapping

from shared.mapgraph.merging.candidates import Candidate, MergeRefusedError, candidates_of
from shared.mapgraph.merging.overlay import groups_of, largest_overlay
from shared.mapgraph.merging.sight_graph import SightGraph
from shared.mapgraph.merging.votes import supported, votes_among
from shared.messages.matching import NodeMatch

EDGES_MIN = 8
"""Accepted matches without which all of them may be chance: of aliased views in a village up to 7 supported
one another, none with two made from nearby and only 4 together with such."""

NODES_MIN = 2
"""Nodes of each map between which there must be edges, and such as were made from nearby: one pair alone
could be two spots that look the same from everywhere near."""


def choose(
    base: SightGraph, other: SightGraph, matches: Mapping[int, Iterable[NodeMatch]]
) -> list[Candidate]:
    """The matches that connect the maps, by node of `other`, then of `base`.

    Args:
        base: the map that grows.
        other: the map whose nodes it gets.
        matches: verified matches against `base` by node of `other`; bearings in the node's camera frame.

    Raises:
        MergeRefusedError: the maps share too little, may only look alike, or fit in two ways.
    """
    candidates = candidates_of(base, other, matches)
    alike = f"{len({one.other for one in candidates})} of {len(other.nodes)} look alike"
    votes = votes_among(base, other, candidates)
    held = supported(votes, candidates)
    if not held:
        why = "none is supported" if candidates else "none could be tested"
        raise MergeRefusedError(f"the maps share no place: {alike}, {why}")
    groups = [group for group in groups_of(votes, held) if _stood_there(group)]
    if not groups:
        raise MergeRefusedError(
            f"the maps share too little: {alike}, {len(held)} matches are supported, but not from "
            f"nearby; at least {NODES_MIN} nodes of each map must be nearly the same"
        )
    chosen = supported(votes, largest_overlay(base, other, groups))
    if len(chosen) < EDGES_MIN or _nodes(chosen) < NODES_MIN:
        raise MergeRefusedError(
            f"the maps share too little: {alike}, {len(chosen)} edges are supported, at least "
            f"{EDGES_MIN} between {NODES_MIN} nodes of each map are needed"
        )
    return sorted(chosen, key=lambda one: (one.other, one.base))


def _stood_there(group: Iterable[Candidate]) -> bool:
    """Whether these are more than houses that look alike, which support one another as well.

    In two parts of a village 36 m apart 56 matches were trusted and 27 of them supported one another, in sets
    of up to 6; all were wrong, and none was made from nearby.
    """
    return _nodes([one for one in group if one.near]) >= NODES_MIN


def _nodes(chosen: Collection[Candidate]) -> int:
    """Nodes that they join, of the map that has fewer."""
    return min(len({one.other for one in chosen}), len({one.base for one in chosen}))
