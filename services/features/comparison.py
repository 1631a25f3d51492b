"""Which candidates to verify and how to order the answer. Pure."""

from collections.abc import Mapping, Sequence

from services.features.interfaces import IndexArray
from shared.messages.matching import NodeMatch

SHORTLIST_FACTOR = 2
"""Candidates verified per place asked for: at 1 to 3 m about half of the raw matches are wrong,
so the most similar places are among the first 2 k by raw count, not surely among the first k."""


def shortlist(pairs: Mapping[int, IndexArray], best_k: int) -> list[int]:
    """Node ids with the most raw matches, at most 2 best_k of them; ties by id."""
    ranked = sorted(pairs, key=lambda node_id: (-len(pairs[node_id]), node_id))
    return ranked[: SHORTLIST_FACTOR * best_k]


def most_similar(results: Sequence[NodeMatch]) -> list[NodeMatch]:
    """Most inliers first, then most raw matches, then the lower id."""
    return sorted(results, key=lambda match: (-match.inliers, -match.raw_matches, match.node_id))


def answer(
    results: Mapping[int, NodeMatch], node_ids: Sequence[int], shortlisted: Sequence[int], best_k: int
) -> tuple[NodeMatch, ...]:
    """The nodes asked for, every target (negative id) and the best_k of the shortlist, most similar first."""
    best = most_similar([results[node_id] for node_id in shortlisted])[:best_k]
    wanted = {*node_ids, *(match.node_id for match in best), *(n for n in results if n < 0)}
    return tuple(most_similar([results[node_id] for node_id in wanted]))
