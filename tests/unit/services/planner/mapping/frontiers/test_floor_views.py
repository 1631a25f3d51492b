"""Floor behind a wall that was seen from close by all along counts nothing, past a door in it what it is."""

import math

import numpy as np
import pytest

from services.planner.mapping.frontiers.floor_views import APART_M, OCCLUDED, FloorViews
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.relative_poses import RelativePose
from shared.messages.sensors import Ranges

RADIUS_M = 0.27
COVERS_M = 1.0
ANGLES_RAD = tuple(math.radians(30 * n) for n in range(12))
WITHIN_BEAM_RAD = np.deg2rad(np.arange(-15.0, 15.1, 1.0))


def pose(x_m=0.0, y_m=0.0, yaw_rad=0.0):
    return RelativePose(np.array([x_m, y_m]), np.zeros((2, 2)), yaw_rad, 0.0)


def along_wall(away_m, door=None, yaw_rad=0.0):
    """Views every 10 cm along a wall to the left of a robot, which may have a door from x to x."""
    views = FloorViews(RADIUS_M)
    for x_m in np.arange(-2.0, 2.01, 0.1):
        views.add(Displacement(0, x_m, 0.0, yaw_rad), wall(x_m, away_m, door, yaw_rad))
    return views


def wall(x_m, away_m, door, yaw_rad):
    """What the beams read there: each the nearest thing in it."""

    def echo_m(angle_rad):
        up = math.sin(angle_rad)
        if up <= 1e-6:
            return 4.0
        in_door = door is not None and door[0] < x_m + away_m / math.tan(angle_rad) < door[1]
        return 4.0 if in_door else min(4.0, away_m / up)

    return read([min(echo_m(yaw_rad + middle + off) for off in WITHIN_BEAM_RAD) for middle in ANGLES_RAD])


def read(distances_m):
    return Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=tuple(distances_m), max_range_m=4.0)


def counts(views, *floor_m, poses=None, covers_m=COVERS_M):
    return views.weights(np.array(floor_m), views.around(poses or {0: pose()}, covers_m), covers_m).tolist()


def test_floor_that_a_beam_passed_over_counts_in_full():
    assert counts(along_wall(1.0), (0.0, 0.5), (1.0, -2.0)) == [1.0, 1.0]


@pytest.mark.parametrize("yaw_rad", [0.0, 0.9])
def test_behind_a_wall_seen_from_close_by_there_is_nothing(yaw_rad):
    assert counts(along_wall(1.0, yaw_rad=yaw_rad), (0.0, 1.5), (0.7, 1.6), (0.0, 5.5)) == [0.0, 0.0, 0.0]


def test_behind_a_wall_seen_from_afar_there_may_be_a_room():
    assert counts(along_wall(2.0), (0.0, 2.6)) == [OCCLUDED]


def test_through_the_narrowest_door_floor_is_seen_from_close_by():
    assert counts(along_wall(1.2, door=(-0.41, 0.41)), (0.0, 1.8)) == [1.0]
    assert counts(along_wall(1.2, door=(-0.41, 0.41)), (1.5, 1.8)) == [0.0]


def test_where_nodes_cover_much_a_wall_seen_from_afar_along_a_way_hides_nothing():
    wide = {"covers_m": 4.0}
    assert counts(along_wall(2.0), (0.0, 3.0), (0.5, 4.0), **wide) == [0.0, 0.0]
    assert counts(along_wall(2.0, door=(-0.41, 0.41)), (0.0, 3.0), (1.6, 2.5), **wide) == [1.0, 0.0]


def test_floor_beside_what_was_seen_may_belong_to_it():
    assert counts(along_wall(1.0), (0.0, 1.0)) == [OCCLUDED]


def test_views_lie_where_their_nodes_do():
    views = along_wall(1.0)
    turned = {0: pose(3.0, 1.0, math.pi / 2)}
    assert counts(views, (2.5, 1.0), (1.5, 1.0), poses=turned) == [1.0, 0.0]
    assert counts(views, (0.0, 0.5), poses={7: pose()}) == [0.0]
    ahead = FloorViews(RADIUS_M)
    ahead.add(Displacement(0, 1.0), wall(1.0, 0.9, None, 0.0))
    assert counts(ahead, (3.2, 5.0), poses=turned) == [1.0]


def test_a_robot_that_stands_adds_no_views():
    views = FloorViews(RADIUS_M)
    views.add(Displacement(0), wall(0.0, 1.0, None, 0.0))
    views.add(Displacement(0, 0.9 * APART_M), read([4.0] * 12))
    assert counts(views, (0.0, 1.5)) == [OCCLUDED]
    views.add(Displacement(0, 1.1 * APART_M), read([4.0] * 12))
    assert counts(views, (0.0, 1.5)) == [1.0]


def test_less_than_three_views_from_close_by_show_no_wall():
    """The frame of a door, or a table beside a passage, hides what is behind it from where the robot is."""
    views = FloorViews(RADIUS_M)
    for number, x_m in enumerate((0.0, 0.3, 0.6)):
        assert number == 0 or counts(views, (0.3, 1.6)) == [OCCLUDED]
        views.add(Displacement(0, x_m), wall(x_m, 1.0, None, 0.0))
    assert counts(views, (0.3, 1.6)) == [0.0]


def test_a_spot_passed_again_is_not_seen_twice():
    """Three departures from a node past the frame of a door are no three views of a wall."""
    views = FloorViews(RADIUS_M)
    for x_m in (0.0, 0.3, 0.0, 0.3, 0.0, 0.3):
        views.add(Displacement(0, x_m), wall(x_m, 1.0, None, 0.0))
    assert counts(views, (0.3, 1.6)) == [OCCLUDED]


def test_only_nodes_with_views_are_covered():
    views = along_wall(1.0)
    assert [views.cover(node) for node in (0, 1)] == [True, False]
