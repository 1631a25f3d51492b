"""Who was found at one of several places that look alike finds out by and by which of them it is."""

import itertools
import math

import pytest

from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from services.planner.travel.rivals import LOOK_M, SHARPNESS, TAKES_OVER
from services.planner.travel.tracking import Tracker
from services.planner.travel.whereabouts import Rival, Whereabouts
from shared.mapgraph.local.displacement import Displacement
from shared.messages.sensors import Ranges
from shared.motion.motion import Motion
from tests.unit.services.planner.travel.seen import Maps, Matcher, by_node, features, match
from tests.unit.shared.mapgraph.local.grid import grid

GRAPH = grid(20, 2)
RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(4.0,) * 12, max_range_m=4.0)
FRAMES = itertools.count()
AWAY = 9
"""So many nodes further on it looks alike."""
EQUAL, LESS, NONE = (60, 50), (42, 35), (0, 0)
TOLD_BY = math.ceil(math.log(TAKES_OVER) / -math.log((LESS[0] / EQUAL[0]) ** SHARPNESS))
"""Views after which a place is not gone by any more that always has less than another."""


def view(x_m, there, away):
    """Of two nodes around a spot so far beyond node 0, and of the two that look like them."""
    first = int(x_m)
    seen = [(first + k, first + k - x_m, s) for k, s in enumerate(there)]
    seen += [(first + k + AWAY, first + k - x_m, s) for k, s in enumerate(away)]
    return by_node(*(match(node, ahead_m, 0.0, s) for node, ahead_m, s in seen if s))


class Robot:
    """Begins beside node 0, or at what looks alike, and drives on along the row."""

    def __init__(self, at=None, *, certain=False):
        self.at, self.x_m = at or Whereabouts("flat"), 0.2
        self.tracker = Tracker(DEFAULT, Maps(GRAPH), Matcher(), certain=certain, whereabouts=self.at)

    def sees(self, there, away, way_m=LOOK_M):
        """The node about which the robot is then, and whether it learnt that it was mistaken."""
        self.x_m += way_m
        self.tracker.observe(Observation(features(next(FRAMES)), RANGES, Motion(way_m, 0.0)))
        of_map = self.tracker.here is None or self.tracker.compared > 0
        self.tracker.confirm(self.tracker.possible(view(self.x_m, there, away), of_map=of_map))
        return self.tracker.here.node_id, self.tracker.mistaken


@pytest.fixture
def robot():
    """It went for the wrong one, which had more matches."""
    mistaken = Robot()
    assert mistaken.sees((60, 50), (63, 52), 0.0)[0] >= AWAY
    return mistaken


def test_it_goes_by_the_other_place_once_views_tell_them_apart(robot):
    found = [robot.sees(EQUAL, LESS) for _ in range(TOLD_BY + 1)]
    assert [node < AWAY for node, _ in found][-1]
    assert sum(mistaken for _, mistaken in found) == 1


def test_views_that_look_alike_change_nothing(robot):
    assert all(robot.sees(EQUAL, EQUAL)[0] >= AWAY for _ in range(6))


def test_one_view_alone_tells_where_the_other_place_does_not_show_at_all(robot):
    assert robot.sees(EQUAL, NONE) == (0, True)


def test_who_was_right_stays_there_and_forgets_the_other_in_the_end(robot):
    assert all(robot.sees(LESS, EQUAL)[0] >= AWAY for _ in range(8))
    assert robot.at.rivals == []
    assert robot.tracker.elsewhere == []


def test_it_goes_back_where_later_views_speak_for_the_first_place(robot):
    robot.sees(EQUAL, NONE)
    assert [robot.sees(NONE, EQUAL) for _ in range(3)][-1][0] >= AWAY


def test_who_stands_still_learns_nothing_new(robot):
    robot.sees(EQUAL, LESS)
    assert all(robot.sees(EQUAL, LESS, 0.0)[0] >= AWAY for _ in range(20))


def test_the_nodes_around_the_other_place_are_compared_now_and_then(robot):
    assert robot.tracker.elsewhere == []
    robot.sees(EQUAL, EQUAL, 0.8 * LOOK_M)
    assert robot.tracker.compared == 0
    robot.tracker.observe(Observation(features(next(FRAMES)), RANGES, Motion(0.3 * LOOK_M, 0.0)))
    assert robot.tracker.compared > 0
    assert 1 in robot.tracker.elsewhere


def test_one_place_alone_has_no_rivals():
    sure = Robot()
    sure.sees((60, 50), (10, 8), 0.0)
    assert sure.at.rivals == []
    sure.sees(EQUAL, NONE, 0.8 * LOOK_M)
    sure.sees(EQUAL, NONE, 0.8 * LOOK_M)
    assert sure.tracker.compared == 0


def test_the_next_mission_goes_on_from_there(robot):
    later = Robot(robot.at.of("flat"))
    assert [later.sees(EQUAL, NONE) for _ in range(2)][-1][0] < AWAY
    assert robot.at.of("another").rivals == []


def test_one_that_maps_is_sure_of_where_it_is():
    rivals = [Rival(Displacement(0, 0.2, spread_m=0.1))]
    mapping = Robot(Whereabouts("flat", rivals=rivals), certain=True)
    mapping.tracker.stand_at(Displacement(AWAY, 0.2, spread_m=0.1))
    mapping.at.rivals = rivals
    for _ in range(3):
        mapping.tracker.observe(Observation(features(next(FRAMES)), RANGES, Motion(LOOK_M, 0.0)))
        mapping.x_m += LOOK_M
        mapping.tracker.possible(view(mapping.x_m, EQUAL, NONE), of_map=True)
        assert mapping.tracker.here.node_id >= AWAY


def test_a_place_whose_node_is_gone_is_forgotten(robot):
    robot.at.rivals = [Rival(Displacement(999))]
    robot.sees(EQUAL, EQUAL, 0.1 * LOOK_M)
    assert robot.at.rivals == []


def test_what_comes_to_the_place_by_which_the_robot_goes_is_no_other(robot):
    robot.at.rivals.append(Rival(robot.tracker.here))
    robot.sees(EQUAL, EQUAL)
    assert [rival.here.node_id < AWAY for rival in robot.at.rivals] == [True]
