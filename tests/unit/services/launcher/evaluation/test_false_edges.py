"""Which edges the truth contradicts."""

import math

import pytest

from services.launcher.evaluation.false_edges import check_edges, true_bearing_rad
from shared.messages.maps import Edge
from shared.messages.simulation import Pose

ORIGIN = Pose(x_m=0.0, y_m=0.0, yaw_rad=0.0)
LEFT = Pose(x_m=0.0, y_m=2.0, yaw_rad=math.pi / 2)
FAR = Pose(x_m=3.5, y_m=0.0, yaw_rad=0.0)


def one(edge, a, b, sight=True):
    (check,) = check_edges([edge], {0: a, 1: b}, lambda *_: sight)
    return check


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
