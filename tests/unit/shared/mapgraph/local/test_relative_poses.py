"""Bearings, yaws and driven lengths say where nodes lie relative to one of them."""

import math

import numpy as np
import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.relative_poses import relative_poses
from shared.messages.maps import Edge, Node
from tests.unit.shared.mapgraph.local.grid import at, edge, grid


def poses_of(graph, root, most=200):
    return relative_poses(graph, root, list(graph.nodes), most)


def test_a_grid_is_where_it_is():
    poses = poses_of(grid(5, 4), 0)
    for node, pose in poses.items():
        np.testing.assert_allclose(pose.position_m, at(node, 5), atol=0.02)
        assert abs(pose.yaw_rad) < 1e-6


def test_the_root_is_the_origin_and_its_camera_the_frame():
    turned = [
        Edge(a=0, b=1, heading_ab_rad=0.0, heading_ba_rad=math.pi / 2, yaw_ab_rad=math.pi / 2, length_m=2.0),
        Edge(a=1, b=2, heading_ab_rad=0.0, heading_ba_rad=3.1, yaw_ab_rad=0.0, length_m=1.0),
    ]
    poses = poses_of(MapGraph([Node(node_id=n) for n in range(3)], turned), 0)
    np.testing.assert_allclose(poses[0].position_m, (0.0, 0.0), atol=1e-9)
    np.testing.assert_allclose(poses[2].position_m, (2.0, 1.0), atol=0.01)
    assert poses[2].yaw_rad == pytest.approx(math.pi / 2)


def test_a_wrong_edge_bends_little():
    graph = grid(6, 6)
    wrong = edge(0, 1, 6).model_copy(update={"a": 0, "b": 35, "length_m": None})
    bent = MapGraph(graph.nodes.values(), [*graph.edges.values(), wrong])
    np.testing.assert_allclose(poses_of(bent, 0)[35].position_m, (5.0, 5.0), atol=0.35)


def test_bearings_alone_hold_the_shape_together_and_lengths_the_scale():
    graph = grid(4, 4)
    edges = [
        e if e.b == e.a + 1 and e.b < 4 else e.model_copy(update={"length_m": None})
        for e in graph.edges.values()
    ]
    poses = poses_of(MapGraph(graph.nodes.values(), edges), 0)
    np.testing.assert_allclose(poses[15].position_m, (3.0, 3.0), atol=0.2)


def test_what_is_further_by_edges_is_less_certain():
    poses = poses_of(grid(12, 1), 0)
    stds = [float(np.sqrt(np.trace(poses[n].covariance_m2))) for n in range(12)]
    assert stds == sorted(stds)
    assert stds[0] == 0.0
    assert stds[11] > 0.3


def test_only_the_nearest_nodes_by_edges_are_reckoned_with():
    assert set(poses_of(grid(12, 1), 0, most=4)) == {0, 1, 2, 3}
