"""What a merge adds to the base map: the other map's edges between new ids, and the edges across. Pure."""

from collections.abc import Iterator, Sequence

from shared.mapgraph.edge_ends import edge_between
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.merging.candidates import INLIERS_MIN, Candidate, MergeRefusedError
from shared.messages.maps import Edge

OPERATIONS_MAX = 10_000
"""As many as one request may hold (`MapRequest.operations`): a revision of any kind holds no more."""


def new_ids(base: MapGraph, other: MapGraph) -> dict[int, int]:
    """New ids in `base` by id in `other`, in the same order: so every edge keeps its direction."""
    return {node_id: base.next_id() + number for number, node_id in enumerate(sorted(other.nodes))}


def joined_edges(other: MapGraph, ids: dict[int, int], chosen: Sequence[Candidate]) -> Iterator[Edge]:
    """The edges of `other` between the nodes' new `ids`, then those that join them to the base map.

    Raises:
        MergeRefusedError: more than one transaction holds.
    """
    check_size(other, len(chosen))
    for edge in other.edges.values():
        yield edge.model_copy(update={"a": ids[edge.a], "b": ids[edge.b]})
    for one in chosen:
        yield _across(ids[one.other], one)


def check_size(other: MapGraph, across: int = 0) -> None:
    """Raise MergeRefusedError when `other` with so many edges to it is more than one transaction holds.

    Args:
        other: the map to be added.
        across: edges between the maps.
    """
    count = len(other.nodes) + len(other.edges) + across
    if count > OPERATIONS_MAX:
        raise MergeRefusedError(
            f"too large: {count} nodes and edges, at most {OPERATIONS_MAX} can be added in one step"
        )


def _across(new_id: int, one: Candidate) -> Edge:
    match = one.match
    return Edge.model_validate(
        {
            **edge_between(new_id, one.base, match.heading_rad, match.yaw_rad),
            "raw_matches": match.raw_matches,
            "inliers": match.inliers,
            "confidence": match.confidence,
            "disparity_rad": match.disparity_rad,
            "s_min": INLIERS_MIN,
            "why": "merged",
        }
    )
