"""What a picture should show: against the picture it is compared with, near enough, and nothing otherwise."""

import numpy as np
import pytest

from experiments.changes.alterations import Alteration
from experiments.changes.altered_world import changed
from shared.messages.inspections import Region
from shared.messages.simulation import Pose

HERE = Pose(x_m=0.0, y_m=0.0, yaw_rad=0.0)
WALL_M, CHAIR_M = 6.0, 2.0


def gone(name, x_m, y_m):
    return Alteration(name, "removed", (x_m, y_m), None, None, 0.3)


AHEAD, LEFT, FAR = gone("ahead", CHAIR_M, 0.0), gone("left", 0.0, CHAIR_M), gone("far", -5.0, 0.0)
BEARING_RAD = {AHEAD: 0.0, LEFT: np.pi / 2, FAR: np.pi}


def measured(without):
    """A round room of an even colour with a thing for each alteration that is not done to it."""
    ranges = np.full((180, 360), WALL_M, np.float32)
    for each in {AHEAD, LEFT, FAR} - set(without):
        columns = (np.arange(-10, 10) + round(180 - np.degrees(BEARING_RAD[each]))) % 360
        ranges[80:100, columns] = np.hypot(*each.before)
    return np.zeros((180, 360, 3), np.uint8), ranges


def told(was, now):
    changes, truth = changed(HERE, measured(was), measured(now), was, now)
    at = [
        Region(bearing_rad=angle, elevation_rad=0.0, width_rad=0.1, height_rad=0.1)
        for angle in (0.0, np.pi / 2)
    ]
    verdict = truth.judge(at)
    return {changes[number - 1].name for number, hit in verdict.by_number.items() if hit}, len(verdict.false)


@pytest.mark.parametrize(("was", "now"), [([], [AHEAD]), ([AHEAD], [])])
def test_what_was_done_or_undone_since_is_a_change_and_the_rest_is_none(was, now):
    assert told(was, now) == ({"ahead"}, 1)


def test_what_was_so_in_the_earlier_picture_is_none():
    assert told([AHEAD], [AHEAD]) == (set(), 2)


def test_one_thing_undone_and_another_done_are_two_changes():
    assert told([AHEAD], [LEFT]) == ({"ahead", "left"}, 0)


def test_what_is_far_away_is_not_asked_for():
    changes, truth = changed(HERE, measured([]), measured([FAR]), [], [FAR])
    assert changes == [FAR]
    assert truth.judge([]).by_number == {}
