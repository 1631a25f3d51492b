"""Rendered pictures under disturbances that act in the scene, and after changes of the world."""

import numpy as np
import pytest

from simulator.disturbances.levels import Disturbances
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


def test_tilt_turns_the_picture_by_what_it_says(world, clear_picture):
    tilted = simulated(world, tilt=1.0)
    picture = tilted.panorama_at(*HERE)
    assert (picture != clear_picture).any()
    assert (tilted.panorama_at(*HERE) == picture).all()


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
