"""How far away a node is, whether the way there is free, and how fast to drive: by what the place is like."""

import math

import pytest

from services.planner.ports import Decision
from services.planner.profiles import DEFAULT, THESIS
from services.planner.surroundings import at_speed, is_clear, is_half_clear, length_m
from shared.messages.sensors import Ranges
from tests.unit.services.planner.travel.seen import match
from tests.unit.shared.mapgraph.local.places import ROOM, STREET, inliers_at

ANGLES_RAD = tuple(math.radians(30 * n) for n in range(12))


def ranges(free_m):
    return Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(free_m,) * 12, max_range_m=12.0)


@pytest.mark.parametrize(("graph", "carries_m"), [(ROOM, 0.32), (STREET, 0.6)])
@pytest.mark.parametrize("away_m", [0.5, 1.5, 4.0])
def test_the_same_matches_mean_further_away_in_a_street(graph, carries_m, away_m):
    seen = match(5, away_m, 0.0, inliers_at(away_m, carries_m))
    assert length_m(seen, graph) == pytest.approx(away_m, rel=0.1)


def test_of_a_goal_picture_the_whole_map_tells_how_far_it_is():
    assert length_m(match(-1, 1.5, 0.0, inliers_at(1.5, 0.6)), STREET) == pytest.approx(1.5, rel=0.1)
    assert length_m(match(-1, 0.0, 0.0, 40), ROOM) == 0.0, "without a baseline it is here"


def test_ground_is_free_as_far_as_a_node_lies_in_such_a_place():
    seen = match(5, 1.5, 0.0, 48)
    assert is_clear(seen, ROOM, ranges(2.2), DEFAULT)
    assert not is_clear(seen, STREET, ranges(2.2), DEFAULT)
    assert is_clear(seen, STREET, ranges(4.0), DEFAULT)
    assert is_half_clear(seen, STREET, ranges(2.2), DEFAULT)
    assert not is_half_clear(seen, STREET, ranges(1.2), DEFAULT)


def test_the_robot_drives_half_its_speed_in_a_room_and_nearly_all_of_it_in_a_street():
    go = Decision("go", 0.1, speed_fraction=0.8)
    assert at_speed(go, ROOM, 5, DEFAULT).speed_fraction == pytest.approx(0.4, rel=0.05)
    assert 0.7 < at_speed(go, STREET, 5, DEFAULT).speed_fraction <= 0.8
    assert at_speed(go, ROOM, 5, THESIS).speed_fraction == 0.8, "its wheels are those of the thesis"
