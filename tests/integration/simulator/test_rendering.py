"""Rendered panoramas: directions, borders, own body, the hider, repeatability."""

import numpy as np
import pytest

from simulator.settings import CameraSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

pytestmark = pytest.mark.render
WIDTH = 512
HEIGHT = WIDTH // 2


@pytest.fixture(scope="module")
def simulation(room_data):
    return Simulation(
        WorldFile.model_validate(room_data), SimulationSettings(camera=CameraSettings(width_px=WIDTH))
    )


@pytest.fixture(autouse=True)
def at_start(simulation):
    simulation.reset(0)
    simulation.remove_hider()


def rows_between(top_deg, bottom_deg):
    return slice(int((90 - top_deg) / 180 * HEIGHT), int((90 - bottom_deg) / 180 * HEIGHT))


def reddish(picture):
    blue, green, red = (picture[..., k].astype(int) for k in range(3))
    return (red > 1.5 * green) & (red > 1.5 * blue) & (red > 60)


def mean_column(mask):
    angles = 2 * np.pi * np.nonzero(mask)[1] / WIDTH
    return float(np.angle(np.exp(1j * angles).mean()) * WIDTH / (2 * np.pi)) % WIDTH


def test_picture_is_two_to_one_bgr_bytes(simulation):
    picture = simulation.panorama()
    assert picture.shape == (HEIGHT, WIDTH, 3)
    assert picture.dtype == np.uint8


def test_red_rug_on_the_left_appears_a_quarter_of_the_width_left_of_the_centre(simulation):
    mask = reddish(simulation.panorama()[rows_between(0, -60)])
    assert mask.sum() > 50
    assert mean_column(mask[:, :]) == pytest.approx(WIDTH / 4, abs=4)


def test_turning_left_by_a_right_angle_brings_it_to_the_centre(simulation):
    simulation.place_robot(2.0, 2.0, np.pi / 2)
    assert mean_column(reddish(simulation.panorama()[rows_between(0, -60)])) == pytest.approx(
        WIDTH / 2, abs=4
    )


def test_turning_by_a_right_angle_rolls_the_picture_by_a_quarter(simulation):
    one = simulation.panorama_at(2.0, 2.0, 0.0)[rows_between(80, -60)].astype(int)
    two = simulation.panorama_at(2.0, 2.0, np.pi / 2)[rows_between(80, -60)].astype(int)
    assert np.abs(np.roll(one, WIDTH // 4, axis=1) - two).mean() < 0.6


def test_borders_between_faces_do_not_show(simulation):
    picture = simulation.panorama_at(2.0, 2.0, 0.4)[HEIGHT // 2 - 20 : HEIGHT // 2 + 20].astype(int)
    steps = np.abs(np.diff(picture, axis=1, append=picture[:, :1])).max(axis=(0, 2))
    borders = [WIDTH // 8, 3 * WIDTH // 8, 5 * WIDTH // 8, 7 * WIDTH // 8]
    for border in borders:
        near = steps[[(border - 1) % WIDTH, border % WIDTH]].max()
        around = np.delete(steps[border - 12 : border + 12], [11, 12]).max()
        assert near <= around + 6


def test_own_body_is_seen_at_the_bottom_and_never_inside_the_crop(simulation):
    seen = simulation.panorama().astype(int)
    simulation.place_robot(40.0, 40.0, 0.0)
    without = simulation.panorama_at(2.0, 2.0, 0.0).astype(int)
    different = np.abs(seen - without).max(axis=2)
    assert (different[rows_between(-70, -90)] > 8).mean() > 0.9
    assert (different[rows_between(65, -65)] <= 2).all()


def test_hider_is_seen_where_it_stands_and_below_the_horizon_only(simulation):
    before = simulation.panorama().astype(int)
    simulation.place_hider(3.2, 2.0, 1.0)
    changed = np.abs(simulation.panorama().astype(int) - before).max(axis=2) > 8
    assert changed.sum() > 100
    assert mean_column(changed) == pytest.approx(WIDTH / 2, abs=6)
    assert not changed[: HEIGHT // 2].any()


def test_a_hider_makes_room_for_who_finds_it(simulation):
    truth = simulation.truth()
    before = simulation.panorama()
    simulation.place_hider(truth.x_m + 0.3, truth.y_m, 1.0)
    np.testing.assert_array_equal(simulation.panorama(), before)


def test_same_pose_gives_the_same_bytes(simulation):
    np.testing.assert_array_equal(simulation.panorama(), simulation.panorama())


def test_a_scene_from_the_cache_looks_the_same_to_the_last_bit(simulation, room_data, tmp_path):
    world = WorldFile.model_validate(room_data)
    settings = SimulationSettings(camera=CameraSettings(width_px=WIDTH), cache_dir=tmp_path)
    for _ in range(2):  # the first fills the cache, the second reads it
        np.testing.assert_array_equal(Simulation(world, settings).panorama(), simulation.panorama())
    assert len(list(tmp_path.iterdir())) > 5
