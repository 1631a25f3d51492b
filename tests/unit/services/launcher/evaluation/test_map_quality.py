"""How good a map is, judged on the truth: coverage, connected parts, false edges."""

import math

import numpy as np
import pytest

from services.launcher.evaluation.map_quality import check_edges, components, coverage, true_bearing_rad
from shared.messages.maps import Edge
from shared.messages.simulation import Pose

FLOOR_M = np.stack(np.meshgrid(np.arange(10.0), [0.0]), axis=-1).reshape(-1, 2)
ORIGIN = Pose(x_m=0.0, y_m=0.0, yaw_rad=0.0)
LEFT = Pose(x_m=0.0, y_m=2.0, yaw_rad=math.pi / 2)
FAR = Pose(x_m=3.5, y_m=0.0, yaw_rad=0.0)


def one(edge, a, b, sight=True):
    (check,) = check_edges([edge], {0: a, 1: b}, lambda *_: sight)
    return check


def test_floor_at_most_the_radius_away_counts_and_the_rest_does_not():
    assert coverage(FLOOR_M, np.array([[0.0, 0.0], [5.0, 0.0]]), 1.0) == 0.5  # 0, 1 and 4, 5, 6


def test_a_map_without_nodes_covers_nothing():
    assert coverage(FLOOR_M, np.zeros((0, 2))) == 0.0


def test_many_cells_give_the_same_as_few():
    rng = np.random.default_rng(1)
    floor_m, nodes_m = rng.uniform(0, 20, (10_000, 2)), rng.uniform(0, 20, (30, 2))
    near = [bool((np.hypot(*(nodes_m - point).T) <= 1.0).any()) for point in floor_m]
    assert coverage(floor_m, nodes_m) == pytest.approx(np.mean(near))


def test_no_floor_is_an_error():
    with pytest.raises(ValueError, match="at least one point"):
        coverage(np.zeros((0, 2)), np.zeros((1, 2)))


@pytest.mark.parametrize(
    ("nodes", "edges", "count"),
    [
        pytest.param([], [], 0, id="nothing"),
        pytest.param([3, 7], [], 2, id="two alone"),
        pytest.param([0, 1, 2, 3], [(0, 1), (2, 3)], 2, id="two pairs"),
        pytest.param([0, 1, 2, 3], [(2, 3), (0, 1), (1, 2), (0, 3)], 1, id="a ring"),
    ],
)
def test_components_are_counted(nodes, edges, count):
    assert components(nodes, edges) == count


def test_true_bearing_is_in_the_frame_of_the_first_pose():
    assert true_bearing_rad(ORIGIN, LEFT) == pytest.approx(math.pi / 2)
    assert abs(true_bearing_rad(LEFT, ORIGIN)) == pytest.approx(math.pi)
    assert true_bearing_rad(LEFT, FAR) == pytest.approx(math.atan2(-2.0, 3.5) - math.pi / 2)


@pytest.mark.parametrize(
    ("offset_deg", "false"), [(19.0, False), (21.0, True), (-21.0, True), (341.0, False)]
)
def test_a_bearing_is_false_beyond_twenty_degrees(offset_deg, false):
    heading = math.remainder(math.pi / 2 + math.radians(offset_deg), math.tau)
    assert one(Edge(a=0, b=1, heading_ab_rad=heading), ORIGIN, LEFT).false is false


def test_the_bearing_back_counts_too():
    edge = Edge(a=0, b=1, heading_ab_rad=math.pi / 2, heading_ba_rad=0.0)
    assert one(edge, ORIGIN, LEFT).false


def test_far_ends_out_of_sight_are_false_even_without_a_bearing():
    assert one(Edge(a=0, b=1), ORIGIN, FAR, sight=False).false
    assert not one(Edge(a=0, b=1), ORIGIN, FAR, sight=True).false
    assert not one(Edge(a=0, b=1), ORIGIN, LEFT, sight=False).false  # 2 m: near enough
