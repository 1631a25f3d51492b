"""Which candidates to verify and how to order the answer. Pure."""

from collections.abc import Mapping, Sequence

from services.features.pipeline.interfaces import Matched
from shared.messages.matching import NodeMatch

SHORTLIST_FACTOR = 2
"""Candidates verified per node asked for: at 1 to 3 m half of the raw matches are wrong (decision 0003), so
the most similar nodes are among the first 2 k by raw count, not surely among the first k."""

CONSIDERED_LEAST, CONSIDERED_FACTOR = 24, 8
"""Nodes of a large map whose features are compared, in all and per node asked for: of 400 pictures all had
the most similar node among the first 10 by global descriptor, and 99 % of their six most similar ones among
the first 64 (`topnav study scale`)."""


def considered(best_k: int) -> int:
    """Nodes of a large map whose features are compared, chosen by their global descriptors."""
    return max(CONSIDERED_LEAST, CONSIDERED_FACTOR * best_k)


def shortlist(pairs: Mapping[int, Matched], best_k: int) -> list[int]:
    """Node ids with the most raw matches, at most 2 best_k of them; ties by id."""
    ranked = sorted(pairs, key=lambda node_id: (-len(pairs[node_id]), node_id))
    return ranked[: SHORTLIST_FACTOR * best_k]


def most_similar(results: Sequence[NodeMatch]) -> list[NodeMatch]:
    """Most inliers first, then most raw matches, then the lower id."""
    return sorted(results, key=lambda match: (-match.inliers, -match.raw_matches, match.node_id))


def is_settled(best: Sequence[NodeMatch], best_k: int, raw_matches: int) -> bool:
    """Whether a candidate with this many raw matches can no longer enter the best_k.

    Inliers are raw matches, so candidates tried in falling order of raw matches need not all be verified.
    """
    ranked = most_similar(best)
    return len(ranked) >= best_k and (best_k == 0 or ranked[best_k - 1].inliers >= raw_matches)


def answer(
    results: Mapping[int, NodeMatch], asked: Sequence[int], best: Sequence[NodeMatch], best_k: int
) -> tuple[NodeMatch, ...]:
    """What was asked for by id and the best_k of those verified for that, most similar first."""
    wanted = {*asked, *(match.node_id for match in most_similar(best)[:best_k])}
    return tuple(most_similar([results[node_id] for node_id in wanted]))
