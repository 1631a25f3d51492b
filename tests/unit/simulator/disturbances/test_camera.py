"""Effects in the picture: nothing at level 0, the same again for the same seed, and what each should do."""

import math

import numpy as np
import pytest

from simulator.disturbances.blur import EXPOSURE_S, mean_picture, poses_of
from simulator.disturbances.camera import Moment, degraded
from simulator.disturbances.exposure import exposed, stops
from simulator.disturbances.fog import VISIBILITY_M, fog_of
from simulator.disturbances.leaning import lean_of
from simulator.disturbances.levels import Disturbances
from simulator.disturbances.mount import mounted
from simulator.disturbances.noise import noisy, spread
from simulator.disturbances.rain import _pixels, rained
from simulator.disturbances.tilt import MOST_RAD, tilt_of
from simulator.sensors.attitude import LEVEL, UPRIGHT, gravity_in, leaning

HERE = Moment(3, 1.5, (1.0, 2.0, 0.5))
IN_PICTURE = ("rain", "noise", "exposure")


@pytest.fixture(scope="module")
def picture():
    return np.random.default_rng(0).integers(0, 256, (128, 256, 3), np.uint8)


def test_no_level_leaves_the_very_picture(picture):
    assert degraded(picture, Disturbances(), HERE) is picture


@pytest.mark.parametrize("name", IN_PICTURE)
def test_same_seed_time_and_place_give_the_same_picture(picture, name):
    levels = Disturbances(**{name: 0.7})
    first = degraded(picture, levels, HERE)
    assert (first != picture).any()
    assert (degraded(picture, levels, HERE) == first).all()
    assert (degraded(picture, levels, Moment(4, 1.5, HERE.place)) != first).any()


@pytest.mark.parametrize("name", ["rain", "noise"])
def test_every_moment_has_its_own_draw(picture, name):
    levels = Disturbances(**{name: 0.7})
    later = Moment(3, 1.8, HERE.place)
    assert (degraded(picture, levels, HERE) != degraded(picture, levels, later)).any()


def test_noise_has_the_spread_it_says_and_grows_with_level():
    grey = np.full((200, 400, 3), 120, np.uint8)
    sigmas = [noisy(grey, level, np.random.default_rng(1)).std() for level in (0.33, 0.66, 1.0)]
    assert sigmas == sorted(sigmas)
    assert sigmas[1] == pytest.approx(spread(0.66)[120], rel=0.05)


def test_exposure_swings_about_the_right_one_and_clips():
    errors = [stops(1.0, 2, t) for t in np.arange(0.0, 200.0, 0.5)]
    assert min(errors) < -1.0 < 1.0 < max(errors)
    assert max(map(abs, errors)) <= 2.0
    bright = exposed(np.full((2, 4, 3), 200, np.uint8), 1.0)
    assert (bright == 255).all()
    assert (exposed(np.full((2, 4, 3), 100, np.uint8), 1.0) == round(100 * 2 ** (1 / 2.2))).all()


def test_falling_drop_stays_in_its_column_and_left_is_left():
    points = np.array([[0.0, 1.0, 0.3], [0.0, 1.0, -0.3]])
    columns, rows = _pixels(points, 400)
    assert columns == pytest.approx([99.5, 99.5])
    assert rows[0] < 99.5 < rows[1]


def test_rain_changes_few_pixels_and_brightens(picture):
    dark = np.full((256, 512, 3), 40, np.uint8)
    wet = rained(dark, 1.0, 1, 0.0).astype(int)
    assert 0.005 < (np.abs(wet - 40).max(axis=-1) > 20).mean() < 0.25
    assert wet.min() >= 39
    assert rained(picture, 0.0, 1, 0.0) is picture


def test_fog_leaves_five_percent_at_the_visibility():
    fog = fog_of(1.0, 0.0, 0.0, "indoor")
    assert math.exp(-fog.extinction * VISIBILITY_M["indoor"]) == pytest.approx(0.05, abs=0.001)
    assert fog_of(0.0, 0.0, 0.0, "outdoor").extinction == 0.0
    assert fog_of(0.0, 1.0, 0.0, "outdoor").extinction > 0.0


def test_blur_looks_back_along_the_motion_and_not_at_rest():
    assert poses_of((1.0, 2.0, 0.3), (0.4, 0.0, 0.0), 0.0) == [(1.0, 2.0, 0.3)]
    assert poses_of((1.0, 2.0, 0.3), (0.001, 0.0, 0.0), 1.0) == [(1.0, 2.0, 0.3)]
    poses = poses_of((1.0, 2.0, 0.3), (0.4, 0.0, 0.5), 1.0)
    assert poses[0] == (1.0, 2.0, 0.3)
    assert poses[-1] == pytest.approx((1.0 - 0.4 * EXPOSURE_S, 2.0, 0.3 - 0.5 * EXPOSURE_S))
    assert (mean_picture([np.full((1, 2, 3), v, np.uint8) for v in (10, 20, 30, 41)]) == 25).all()


def test_tilt_stays_within_five_degrees_and_sways_only_in_motion():
    assert tilt_of(0.0, 1, 2.0, 0.4) == (0.0, 0.0)
    still = {tilt_of(1.0, 1, t, 0.0) for t in (0.0, 1.0, 2.0)}
    assert len(still) == 1
    moving = [math.hypot(*tilt_of(1.0, 1, t, 0.5)) for t in np.arange(0.0, 3.0, 0.05)]
    assert max(moving) <= MOST_RAD + 1e-12
    assert max(moving) > 0.97 * MOST_RAD
    assert max(moving) - min(moving) > 0.4 * MOST_RAD


def test_mount_leans_by_ten_degrees_in_a_direction_of_the_seed():
    assert mounted(0.0, 1) == LEVEL
    sizes = [math.degrees(math.hypot(*mounted(1.0, seed))) for seed in range(20)]
    assert sizes == pytest.approx([10.0] * 20)
    assert math.degrees(math.hypot(*mounted(0.3, 7))) == pytest.approx(3.0)
    directions = np.array([mounted(1.0, seed) for seed in range(200)])
    assert abs(directions.mean(axis=0)).max() < math.radians(2.0)
    assert mounted(1.0, 7) == mounted(1.0, 7) != mounted(1.0, 8)


def test_tilt_alone_leans_the_camera_by_just_that():
    tilt = tilt_of(1.0, 2, 3.0, 0.4)
    assert lean_of(Disturbances(tilt=1.0), 2, 3.0, 0.4, LEVEL) == leaning(tilt)
    assert lean_of(Disturbances(), 2, 3.0, 0.4, LEVEL) == UPRIGHT


def test_mount_keeps_its_place_on_a_robot_that_rocks_and_adds_as_a_rotation():
    levels = Disturbances(mount=1.0)
    still = {lean_of(levels, 2, time_s, speed_mps, LEVEL) for time_s, speed_mps in ((0.0, 0.0), (9.0, 0.4))}
    assert still == {leaning(mounted(1.0, 2))}
    pitch_rad, roll_rad = mounted(1.0, 2)
    straight = gravity_in(lean_of(levels, 2, 0.0, 0.0, (-pitch_rad, -roll_rad)))
    assert straight == pytest.approx((0.0, 0.0, -1.0))
    across = gravity_in(lean_of(levels, 2, 0.0, 0.0, (roll_rad, -pitch_rad)))
    assert -across[2] == pytest.approx(math.cos(math.radians(10.0)) ** 2)
