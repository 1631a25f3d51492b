"""Mirrored scanners are found by how the room turns."""

import math

import numpy as np
import pytest

from services.ros.conversions.scan import Mount, sectors_of
from services.ros.conversions.turning import TurningCheck
from tests.ros_messages import room, scan


def drive(check, upside_down, turns_rad, ranges=room):
    """Turn on the spot with a scanner that was mounted so without anybody saying it."""
    for yaw_rad in turns_rad:
        ranges_m = ranges(yaw_rad)
        if upside_down:
            ranges_m = ranges_m[-np.arange(len(ranges_m)) % len(ranges_m)]
        profile_m = sectors_of(scan(ranges_m), Mount(), 0.1, 12.0).profile_m
        check.see(profile_m, 0.0, 0.0, yaw_rad)


TURN = np.arange(0.0, 4.0, 0.1)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_scanner_that_turns_as_the_robot_does_is_confirmed(way):
    check = TurningCheck()
    drive(check, False, way * TURN)
    assert check.confirmed
    assert not check.mirrored


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_mirrored_scanner_is_found_while_the_robot_turns(way):
    check = TurningCheck()
    drive(check, True, way * TURN)
    assert check.mirrored
    assert not check.confirmed


def test_nothing_is_said_of_a_robot_that_stands_or_of_a_room_that_is_round():
    check = TurningCheck()
    drive(check, True, [0.0] * 50)
    drive(check, True, TURN, lambda _yaw_rad: np.full(360, 2.0))
    assert not check.mirrored
    assert not check.confirmed


def test_two_scans_of_different_spots_are_not_compared():
    check = TurningCheck()
    for yaw_rad in TURN:
        profile_m = sectors_of(scan(room(-yaw_rad)), Mount(), 0.1, 12.0).profile_m
        check.see(profile_m, math.degrees(yaw_rad), 0.0, yaw_rad)
    assert not check.mirrored
