"""Laser scans as twelve sectors: mounts, free way, blind sectors, and what is no scan."""

import math

import numpy as np
import pytest

from services.ros.conversions.header import ConversionError
from services.ros.conversions.scan import BLIND_M, Mount, sectors_of
from tests.ros_messages import room, scan

HERE = Mount()
BESIDE_M = 0.03
"""A reading on the border of two sectors, as at 135 degrees, belongs to either; the next one is that far."""


def sectors(message, mount=HERE, own_radius_m=0.1, max_m=4.0, nothing="inf"):
    return sectors_of(message, mount, own_radius_m, max_m, nothing)


def test_each_sector_has_its_nearest_reading_counted_counter_clockwise_from_ahead():
    ranges = np.full(360, 3.0)
    ranges[3], ranges[90], ranges[270] = 1.0, 1.5, 2.0  # ahead, left, right
    told = sectors(scan(ranges)).distances_m
    assert told[0] == pytest.approx(1.0)
    assert told[3] == pytest.approx(1.5)
    assert told[9] == pytest.approx(2.0)
    assert [told[k] for k in (1, 2, 4, 6, 8, 10)] == pytest.approx([3.0] * 6)


def test_infinite_and_far_readings_are_free_way_up_to_the_longest_distance():
    ranges = np.full(360, np.inf)
    ranges[180] = 9.0
    found = sectors(scan(ranges))
    assert found.distances_m == (4.0,) * 12
    assert found.blind == ()
    assert np.isnan(found.profile_m).all()


def test_a_sector_without_readings_is_blind_and_counts_as_occupied():
    ranges = np.full(360, 3.0)
    ranges[136:225] = np.nan
    found = sectors(scan(ranges))
    assert found.blind == (5, 6, 7)
    assert [found.distances_m[k] for k in found.blind] == [BLIND_M] * 3


def test_a_scanner_that_looks_ahead_only_is_blind_behind():
    message = scan(np.full(181, 3.0), angle_min=-math.pi / 2.0)
    message.angle_increment = math.pi / 180.0
    assert sectors(message).blind == (4, 5, 6, 7, 8)


def test_a_scan_of_nan_is_refused_with_what_to_do():
    with pytest.raises(ConversionError, match=r"0 of 360 readings are some, 50% expected.*scan\.nothing"):
        sectors(scan(np.full(360, np.nan)))


@pytest.mark.parametrize(("nothing", "value"), [("nan", np.nan), ("zero", 0.0)])
def test_a_driver_that_writes_nan_or_zero_for_nothing_is_understood_when_told_so(nothing, value):
    ranges = np.full(360, value)
    ranges[0] = 1.0
    with pytest.raises(ConversionError, match="1 of 360"):
        sectors(scan(ranges))
    assert sectors(scan(ranges), nothing=nothing).distances_m == pytest.approx((1.0, *(4.0,) * 11))


def test_what_is_too_near_to_measure_is_as_near_as_the_scanner_measures():
    ranges = np.full(360, 3.0)
    ranges[0] = -np.inf
    assert sectors(scan(ranges, range_min=0.2), own_radius_m=0.1).distances_m[0] == pytest.approx(0.2)


def test_the_robots_own_parts_are_no_obstacles():
    ranges = np.full(360, 3.0)
    ranges[180] = 0.15
    assert sectors(scan(ranges), own_radius_m=0.2).distances_m[6] == pytest.approx(3.0, abs=1e-6)
    assert sectors(scan(ranges), own_radius_m=0.1).distances_m[6] == pytest.approx(0.15)


def test_distances_are_told_from_the_robots_centre_wherever_the_scanner_sits():
    ranges = np.full(360, np.inf)
    ranges[0], ranges[90] = 1.0, 0.3  # ahead, and left of a scanner that sits 0.3 m ahead of the centre
    told = sectors(scan(ranges), Mount(x_m=0.3)).distances_m
    assert told[0] == pytest.approx(1.3)
    assert min(told[1:3]) == pytest.approx(0.3 * math.sqrt(2.0))


def test_a_turned_scanner_and_one_upside_down_tell_the_same_as_one_that_is_mounted_right():
    right = sectors(scan(room())).distances_m
    turned = sectors(scan(room(yaw_rad=math.pi / 2.0)), Mount(yaw_rad=math.pi / 2.0)).distances_m
    upside_down = sectors(scan(room()[-np.arange(360) % 360]), Mount(upside_down=True)).distances_m
    assert turned == pytest.approx(right, abs=BESIDE_M)
    assert upside_down == pytest.approx(right, abs=BESIDE_M)
    assert sectors(scan(room()[-np.arange(360) % 360])).distances_m != pytest.approx(right, abs=0.1)


def test_a_scan_that_counts_clockwise_is_read_as_it_says():
    message = scan(room()[-np.arange(360) % 360])
    message.angle_increment = -message.angle_increment
    assert sectors(message).distances_m == pytest.approx(sectors(scan(room())).distances_m, abs=BESIDE_M)


@pytest.mark.parametrize(
    ("fields", "named"),
    [
        ({"ranges": np.zeros(0, np.float32)}, "12 to 100000 readings expected, got 0"),
        ({"angle_increment": 0.0}, "a step of 0 rad"),
        ({"angle_increment": 1.0}, "two turns"),
        ({"angle_increment": float("nan")}, "must be finite"),
        ({"angle_min": float("inf")}, "must be finite"),
        ({"angle_min": 1.0e30}, "angle_min"),
        ({"range_min": 5.0, "range_max": 1.0}, "range_min below range_max"),
    ],
)
def test_what_cannot_be_a_scan_is_named(fields, named):
    with pytest.raises(ConversionError, match=named):
        sectors(scan(np.full(360, 3.0), **fields))
