"""Distance sensors against known walls and furniture."""

import math

import numpy as np
import pytest

from simulator.scene.parts import Material, Part
from simulator.scene.shapes import box
from simulator.sensors.ranges import measure, sensor_angles_rad
from simulator.settings import RangeSettings
from simulator.world.footprints import footprints

EXACT = RangeSettings(noise_m=0.0)
STUFF = Material("lacquer")
WALL = box((2.0, 2.1), (-5.0, 5.0), (0.0, 2.5), STUFF)


def read(parts, yaw_rad=0.0, settings=EXACT, seed=0):
    return measure(0.0, 0.0, yaw_rad, footprints(parts, 0.02, 0.79), settings, np.random.default_rng(seed))


def test_sensors_stand_thirty_degrees_apart_counter_clockwise():
    np.testing.assert_allclose(np.degrees(sensor_angles_rad(EXACT)), np.arange(0, 360, 30), atol=1e-9)


def test_wall_ahead_is_seen_at_its_distance_and_nothing_behind():
    distances = read((WALL,))
    assert distances[0] == pytest.approx(2.0)
    assert distances[6] == EXACT.max_m


def test_sideways_sensor_reports_the_nearest_point_inside_its_beam():
    beam_edge = math.radians(30 - 15)
    assert read((WALL,))[1] == pytest.approx(2.0 / math.cos(beam_edge))


def test_turning_left_moves_the_wall_to_the_sensors_on_the_right():
    distances = read((WALL,), yaw_rad=math.pi / 2)
    assert distances[9] == pytest.approx(2.0)
    assert distances[0] == EXACT.max_m


@pytest.mark.parametrize(
    ("low", "high", "seen"), [(0.42, 0.46, True), (0.85, 2.0, False), (0.72, 0.75, True)]
)
def test_everything_the_robot_could_hit_is_seen_and_nothing_above_it(low, high, seen):
    shelf = box((1.0, 1.5), (-0.5, 0.5), (low, high), STUFF)
    assert (read((shelf,))[0] < EXACT.max_m) == seen


def test_thin_chair_leg_half_a_metre_away_is_not_missed():
    for angle in np.linspace(-0.26, 0.26, 53):
        leg = Part("box", (0.5 * math.cos(angle), 0.5 * math.sin(angle), 0.2), (0.04, 0.04, 0.4), STUFF)
        assert read((leg,))[0] < 0.55


def test_round_pot_is_seen_at_its_rim():
    pot = Part("cylinder", (1.0, 0.0, 0.2), (0.4, 0.4, 0.4), STUFF)
    assert read((pot,))[0] == pytest.approx(0.8)


@pytest.mark.parametrize(
    "large",
    [
        pytest.param(box((2.0, 2.1), (-3.0, 37.0), (0.0, 2.5), STUFF), id="wall"),
        pytest.param(Part("cylinder", (12.0, 0.0, 0.2), (20.0, 20.0, 0.4), STUFF), id="disc"),
        pytest.param(
            Part("box", (12.0, 0.0, 0.2), (0.1, 20.0, 0.4), STUFF, yaw_rad=math.pi / 2), id="turned"
        ),
    ],
)
def test_large_thing_with_its_middle_out_of_range_is_seen_where_it_is_near(large):
    assert read((large,))[0] == pytest.approx(2.0)


def test_noise_depends_on_the_generator_only():
    noisy = RangeSettings(noise_m=0.05)
    np.testing.assert_array_equal(
        read((WALL,), settings=noisy, seed=1), read((WALL,), settings=noisy, seed=1)
    )
    assert read((WALL,), settings=noisy, seed=1)[0] != read((WALL,), settings=noisy, seed=2)[0]
