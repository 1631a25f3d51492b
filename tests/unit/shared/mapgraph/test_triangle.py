"""A triangle of views: turns that add up, directions that close, and what is unknown."""

import math

import pytest

from shared.mapgraph.triangle import (
    DIRECTION_RAD,
    YAW_RAD,
    Sight,
    apart_rad,
    triangle_closes,
    triangle_misses,
)

# The frame at the origin, the node 1 m ahead and turned left by 0.3, the neighbour 1 m to the left, by 0.5.
NODE, NEIGHBOUR = Sight(0.0, 0.3), Sight(math.pi / 2, 0.5)
ONWARD = Sight(math.radians(135.0) - 0.3, 0.2)


def test_three_true_views_close():
    assert triangle_closes(NODE, NEIGHBOUR, ONWARD)


@pytest.mark.parametrize(("factor", "closes"), [(0.9, True), (1.1, False), (-0.9, True), (-1.1, False)])
def test_turns_may_miss_by_the_tolerance_and_no_more(factor, closes):
    turned = ONWARD._replace(yaw_rad=ONWARD.yaw_rad + factor * YAW_RAD)
    assert triangle_closes(NODE, NEIGHBOUR, turned) is closes


@pytest.mark.parametrize(
    ("lon_deg", "closes"), [(91, True), (179, True), (84, True), (80, False), (200, False)]
)
def test_the_way_on_lies_between_the_neighbour_and_the_way_back(lon_deg, closes):
    """Between 90 and 180 degrees here, and half the tolerance beyond."""
    assert math.degrees(DIRECTION_RAD) == pytest.approx(15.0)
    onward = Sight(math.radians(lon_deg) - NODE.yaw_rad, ONWARD.yaw_rad)
    assert triangle_closes(NODE, NEIGHBOUR, onward) is closes


@pytest.mark.parametrize("which", range(3))
def test_without_a_direction_only_the_turns_count(which):
    sights = [NODE, NEIGHBOUR, Sight(0.0, 0.2)]  # the way on cannot be
    assert not triangle_closes(*sights)
    sights[which] = sights[which]._replace(heading_rad=None)
    assert triangle_closes(*sights)
    sights[which] = sights[which]._replace(yaw_rad=sights[which].yaw_rad + 0.3)
    assert not triangle_closes(*sights)


@pytest.mark.parametrize("which", range(3))
def test_without_a_turn_nothing_closes(which):
    sights = [NODE, NEIGHBOUR, ONWARD]
    sights[which] = sights[which]._replace(yaw_rad=None)
    assert not triangle_closes(*sights)


def test_true_views_miss_nothing_and_a_turn_is_told():
    assert triangle_misses(NODE, NEIGHBOUR, ONWARD) == pytest.approx((0.0, 0.0))
    turned = ONWARD._replace(yaw_rad=ONWARD.yaw_rad - 0.1)
    assert triangle_misses(NODE, NEIGHBOUR, turned) == pytest.approx((0.1, 0.0))


def test_angles_are_compared_across_the_seam():
    assert apart_rad(math.pi - 0.1, -math.pi + 0.1) == pytest.approx(0.2)
    assert apart_rad(0.0, 3.0) == pytest.approx(3.0)
