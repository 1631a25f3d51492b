"""Coverage by how far the robot had driven."""

import numpy as np
import pytest

from services.launcher.drawing.curves import draw_coverage
from services.launcher.evaluation.coverage_curve import coverage_curve, metres_to
from services.launcher.evaluation.map_quality import coverage
from services.launcher.evaluation.truth_file import MapTruth
from shared.messages.simulation import Pose, Truth

FLOOR_M = np.stack(np.meshgrid(np.arange(10.0), [0.0]), axis=-1).reshape(-1, 2)


def at(x_m):
    return Pose(x_m=x_m, y_m=0.0, yaw_rad=0.0)


def drive(*xs_m):
    """True states a metre or less apart, a second from one to the next."""
    return [
        Truth(robot="r1", world="w", seq=k, stamp_ns=k, sim_time_s=float(k), pose=at(x_m), collisions=0)
        for k, x_m in enumerate(xs_m)
    ]


def truth(nodes):
    """Nodes by where they are and when their frames were taken."""
    poses = {node: at(x_m) for node, (x_m, _) in nodes.items()}
    return MapTruth("w", poses, {node: stamp_ns for node, (_, stamp_ns) in nodes.items()})


def test_each_node_adds_what_it_covers_where_it_was_made():
    nodes = truth({0: (0.0, 0), 1: (3.0, 3), 2: (2.0, 4)})
    found = coverage_curve(FLOOR_M, nodes, drive(0.0, 1.0, 2.0, 3.0, 2.0), 1.0)
    np.testing.assert_allclose(found, [(0.0, 0.2), (3.0, 0.5), (4.0, 0.5)])
    positions = np.array([[0.0, 0.0], [3.0, 0.0], [2.0, 0.0]])
    assert found[-1][1] == pytest.approx(coverage(FLOOR_M, positions, 1.0))


def test_nodes_from_before_the_mission_are_there_when_it_begins():
    nodes = truth({0: (8.0, -500), 1: (0.0, 0), 2: (1.0, 1)})
    found = coverage_curve(FLOOR_M, nodes, drive(0.0, 1.0), 1.0)
    assert [metres for metres, _ in found] == [0.0, 0.0, 1.0]


def test_metres_to_a_share_are_those_of_the_first_node_that_reaches_it():
    curve = [(0.0, 0.2), (3.0, 0.5), (4.0, 0.5)]
    assert metres_to(curve, 0.5) == 3.0
    assert metres_to(curve, 0.97) is None


def test_the_curve_is_drawn(tmp_path):
    curves = {"topnav": [(0.0, 0.2), (3.0, 0.5)], "peer": [(0.0, 0.3)]}
    draw_coverage(tmp_path / "curve.png", "exploring nothing", curves, most_m=5.0)
    draw_coverage(tmp_path / "empty.png", "exploring nothing", {"topnav": []})
    assert (tmp_path / "curve.png").read_bytes().startswith(b"\x89PNG")


def test_metres_are_those_of_the_way_and_not_of_the_beeline():
    nodes = truth({0: (0.0, 0), 1: (1.0, 3)})
    found = coverage_curve(FLOOR_M, nodes, drive(0.0, 0.8, 0.4, 1.0), 0.5)
    assert found[-1][0] == pytest.approx(1.8)
