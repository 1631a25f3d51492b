"""A merge as one transaction on the base map: places, their connections, and those between the maps. Pure."""

from collections.abc import Mapping, Sequence

from services.gateway.merging.core.candidates import INLIERS_MIN, Candidate, MergeRefusedError
from services.gateway.merging.core.places import Places
from shared.mapgraph.edge_ends import edge_between
from shared.messages.features import Features
from shared.messages.maps import AddNode, Edge, Operation, PutEdge

OPERATIONS_MAX = 10_000
"""What one transaction may hold; a merge in several could end half done."""


def merged(
    base: Places, other: Places, features: Mapping[int, Features], chosen: Sequence[Candidate]
) -> list[Operation]:
    """Operations that add `other` to `base`.

    Places get new ids in the order of their old ones, so that every connection keeps its direction.

    Args:
        base: the map that grows.
        other: the map to be added.
        features: of each place of `other`.
        chosen: matches that become connections.

    Raises:
        MergeRefusedError: more than one transaction holds.
    """
    check_size(other, len(chosen))
    ids = {node_id: base.next_id() + number for number, node_id in enumerate(sorted(other.nodes))}
    operations: list[Operation] = [
        AddNode(node=other.nodes[old].model_copy(update={"node_id": new}), features=features[old])
        for old, new in ids.items()
    ]
    for edge in other.edges:
        operations.append(PutEdge(edge=edge.model_copy(update={"a": ids[edge.a], "b": ids[edge.b]})))
    operations += [PutEdge(edge=_across(ids[one.other], one)) for one in chosen]
    return operations


def check_size(other: Places, across: int = 0) -> None:
    """Raise MergeRefusedError when `other` with so many connections to it is more than one transaction holds.

    Args:
        other: the map to be added.
        across: connections between the maps.
    """
    count = len(other.nodes) + len(other.edges) + across
    if count > OPERATIONS_MAX:
        raise MergeRefusedError(
            f"too large: {count} places and connections, at most {OPERATIONS_MAX} can be added in one step"
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
