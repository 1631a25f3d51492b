"""Rendered pictures under disturbances that act in the scene, and after changes of the world."""

import math

import cv2
import numpy as np
import pytest

from simulator.disturbances.levels import Disturbances
from simulator.sensors.panorama import directions
from simulator.settings import CameraSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.world_file import WorldFile

pytestmark = pytest.mark.render
WIDTH = 256
HERE = (2.0, 2.0, 0.0)
CAMERA = CameraSettings(width_px=WIDTH)


@pytest.fixture(scope="module")
def world(room_data):
    return WorldFile.model_validate(room_data)


def simulated(world, **levels):
    return Simulation(world, SimulationSettings(camera=CAMERA, disturbances=Disturbances(**levels)), 1)


@pytest.fixture(scope="module")
def clean(world):
    return simulated(world)


@pytest.fixture(scope="module")
def clear_picture(clean):
    return clean.panorama_at(*HERE)


def test_levels_of_zero_give_the_very_same_picture(world, clear_picture):
    zero = simulated(world, **dict.fromkeys(Disturbances.model_fields, 0.0))
    assert (zero.panorama_at(*HERE) == clear_picture).all()


def test_fog_hides_far_things_more_and_leaves_no_trace_in_other_scenes(world, clean, clear_picture):
    foggy = simulated(world, fog=1.0).panorama_at(*HERE)
    change = np.abs(foggy.astype(int) - clear_picture).mean(axis=-1)
    rug, wall_picture = change[75:85, 60:70], change[52:62, 122:134]
    assert wall_picture.mean() > rug.mean()
    assert (clean.panorama_at(*HERE) == clear_picture).all()


def test_lamps_only_is_darker_where_there_is_even_light(world, clear_picture):
    night = simulated(world, illumination=1.0).panorama_at(*HERE)
    assert night.mean() < clear_picture.mean() - 3


def test_light_that_changes_shows_what_a_world_of_that_light_shows(world):
    changed, dusk = simulated(world, fog=0.5), simulated(world, fog=0.5, illumination=0.5)
    noon = changed.panorama_at(*HERE)
    for each in (changed, dusk):
        each.place_hider(HERE[0] + 1.0, HERE[1], 0.0)
    changed.set_light(0.5)
    assert (changed.panorama_at(*HERE) == dusk.panorama_at(*HERE)).all()
    changed.remove_hider()
    changed.set_light(0.0)
    assert (changed.panorama_at(*HERE) == noon).all()


def test_tilt_turns_the_picture_by_what_it_says(world, clear_picture):
    tilted = simulated(world, tilt=1.0)
    picture = tilted.panorama_at(*HERE)
    assert (picture != clear_picture).any()
    assert (tilted.panorama_at(*HERE) == picture).all()


def level_again(picture, gravity):
    """A picture turned so that `gravity`, given in its camera frame, points straight down."""
    down = np.array([0.0, 0.0, -1.0])
    across, cos = np.cross(gravity, down), float(down @ gravity)
    cross = np.array([[0, -across[2], across[1]], [across[2], 0, -across[0]], [-across[1], across[0], 0]])
    upright = np.eye(3) + cross + cross @ cross / (1.0 + cos)  # takes gravity to down
    rays = directions(WIDTH) @ upright  # of the level picture, in the camera's frame
    columns = (math.pi - np.arctan2(rays[..., 1], rays[..., 0])) * WIDTH / (2 * math.pi) - 0.5
    rows = (math.pi / 2 - np.arcsin(np.clip(rays[..., 2], -1, 1))) * WIDTH / (2 * math.pi) - 0.5
    maps = columns.astype(np.float32), rows.astype(np.float32)
    return cv2.remap(picture, *maps, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP)


@pytest.mark.parametrize("rocked_deg", [(15.0, 0.0), (0.0, 15.0), (-8.0, 11.0)])
def test_gravity_of_a_rocking_robots_frame_sets_its_picture_upright(world, clear_picture, rocked_deg):
    settings = SimulationSettings(camera=CAMERA, imu=True, imu_noise_rad=0.0)
    simulation, rocked = Simulation(world, settings, 1), tuple(np.radians(rocked_deg))
    picture, gravity = simulation.panorama_at(*HERE, rocked=rocked), simulation.gravity_at(*HERE, rocked)
    kept = slice(WIDTH // 16, WIDTH // 2 - WIDTH // 8)  # without the poles, and without the robot's own body
    assert off(level_again(picture, gravity)[kept], clear_picture[kept]) < 4.0
    for wrong in ((-gravity[0], -gravity[1], gravity[2]), (0.0, 0.0, -1.0)):
        assert off(level_again(picture, wrong)[kept], clear_picture[kept]) > 10.0


def off(one, other):
    return np.abs(one.astype(int) - other).mean()


def test_mount_leans_every_picture_alike_and_gravity_tells(world, clear_picture):
    levels = Disturbances(mount=1.0)
    settings = SimulationSettings(camera=CAMERA, imu=True, imu_noise_rad=0.0, disturbances=levels)
    simulation = Simulation(world, settings, 1)
    picture, gravity = simulation.panorama_at(*HERE), simulation.gravity_at(*HERE)
    assert math.degrees(math.acos(-gravity[2])) == pytest.approx(10.0)
    assert simulation.gravity_at(1.0, 3.0, 2.0) == gravity
    kept = slice(WIDTH // 16, WIDTH // 2 - WIDTH // 8)
    assert off(level_again(picture, gravity)[kept], clear_picture[kept]) < 4.0


def test_rocking_leans_pictures_of_a_robot_that_drives_and_of_no_other(world, clear_picture):
    rocking, plain = simulated(world, rocking=1.0), simulated(world)
    for simulation in (rocking, plain):
        simulation.command(0.4)
        simulation.step(0.9)
    assert (rocking.panorama() != plain.panorama()).any()
    rocking.reset(1)
    assert (rocking.panorama() == clear_picture).all()


def test_blur_needs_motion(world, clear_picture):
    blurring = simulated(world, blur=1.0)
    assert (blurring.panorama_at(*HERE) == clear_picture).all()
    assert (blurring.panorama_at(*HERE, (0.5, 0.0, 0.0)) != clear_picture).any()


def test_item_disappears_from_the_picture_and_comes_back_unchanged(world, clear_picture):
    changing = simulated(world)
    changing.set_item("picture-1", present=False)
    bare = changing.panorama_at(*HERE)
    assert (bare[:, 118:138] != clear_picture[:, 118:138]).any()
    changing.set_item("picture-1", present=True)
    assert (changing.panorama_at(*HERE) == clear_picture).all()


def test_obstacle_is_seen(world, clear_picture):
    changing = simulated(world)
    changing.place_obstacle("basket", (3.0, 2.0, 0.0))
    change = np.abs(changing.panorama_at(*HERE).astype(int) - clear_picture).max(axis=-1)
    assert (change[70:110, 112:144] > 20).mean() > 0.2
