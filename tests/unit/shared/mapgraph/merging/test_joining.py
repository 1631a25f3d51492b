"""What a merge adds: edges that point where the nodes are, and no more than one revision holds."""

import numpy as np
import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.merging.candidates import MergeRefusedError
from shared.mapgraph.merging.choice import choose
from shared.mapgraph.merging.joining import OPERATIONS_MAX, check_size, joined_edges, new_ids
from shared.messages.maps import Edge, Node
from tests.merge_world import Streets, assert_points, edges_of, row


def test_after_the_merge_every_edge_points_where_the_nodes_are(world: Streets):
    chosen = choose(world.base_map, world.other_map, world.true_matches())
    ids = new_ids(world.base_map, world.other_map)
    first = max(world.base) + 1
    assert ids == {old: first + k for k, old in enumerate(sorted(world.other))}
    edges = list(joined_edges(world.other_map, ids, chosen))
    across = [edge for edge in edges if edge.why == "merged"]
    assert (len(across), len(edges)) == (len(chosen), len(chosen) + len(world.other_map.edges))
    assert all(edge.a < first <= edge.b for edge in across)
    poses = world.base | {new: world.other[old] for old, new in ids.items()}
    for edge in edges:
        assert_points(edge, poses)


def test_a_merge_of_more_than_one_transaction_is_refused():
    nodes = [Node(node_id=n) for n in range(6_000)]
    edges = [Edge(a=n, b=n + 1) for n in range(4_001)]
    with pytest.raises(MergeRefusedError, match=f"10001 nodes and edges, at most {OPERATIONS_MAX}"):
        check_size(MapGraph(nodes, edges))
    largest = MapGraph(nodes, edges[:4_000])
    check_size(largest)
    with pytest.raises(MergeRefusedError, match="10003"):
        check_size(largest, across=3)


def test_edges_of_the_world_are_true():
    """The measure the other tests go by."""
    rng = np.random.default_rng(0)
    poses = dict(enumerate(row(rng, 0.0, 0.0, 3)))
    for edge in edges_of(poses, rng):
        assert_points(edge, poses)
