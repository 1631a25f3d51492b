"""Worlds that nobody tuned, and the examples: they load, have free floor, are shown, and stop the robot."""

import math
from pathlib import Path

import numpy as np
import pytest
import yaml

from simulator.settings import CameraSettings, RangeSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.contents import expand
from simulator.world.footprints import clearance_m, footprints
from simulator.world.freespace import BODY_BAND_M, free_space
from simulator.world.world_check import examine
from simulator.world.world_file import load_world
from tests.random_worlds import random_world

pytestmark = pytest.mark.render
EXAMPLES = Path(__file__).parents[3] / "deploy" / "examples" / "worlds"
SMALL = SimulationSettings(camera=CameraSettings(width_px=256), ranges=RangeSettings(noise_m=0.0))


def picture_of(world, settings=SMALL):
    return Simulation(world, settings, seed=1).panorama()


@pytest.mark.parametrize(("seed", "outdoor"), [(1, False), (2, False), (3, False), (4, True), (5, True)])
def test_random_world_works_as_it_is(tmp_path, seed, outdoor):
    file = tmp_path / "random.yaml"
    file.write_text(yaml.safe_dump(random_world(seed, outdoor, tmp_path)), encoding="utf-8")
    world = load_world(str(file))
    report = examine(world)
    assert report.faults == ()
    assert report.unreachable == ()
    assert report.free_m2 > 0.3 * report.floor_m2
    space = free_space(world)
    assert space.is_free(space.random_pose(np.random.default_rng(seed))[:2])
    picture = picture_of(world)
    assert picture.shape == (128, 256, 3)
    assert picture[:64].std() > 10


@pytest.fixture(scope="module", params=["studio", "courtyard"])
def example(request):
    return load_world(str(EXAMPLES / f"{request.param}.yaml"))


def test_example_has_no_faults_and_no_doubts(example):
    report = examine(example)
    assert (report.faults, report.doubts, report.unreachable) == ((), (), ())


def test_models_of_an_example_are_seen(example):
    without = example.model_copy(
        update={"furniture": tuple(item for item in example.furniture if item.kind != "mesh")}
    )
    difference = np.abs(picture_of(example).astype(int) - picture_of(without).astype(int))
    assert (difference.max(axis=-1) > 40).mean() > 0.003


def test_robot_is_stopped_by_a_model_where_its_sensors_say(example):
    parts, _ = expand(example)
    hulls = [part for part in parts if part.shape == "hull" and part.centre_m[2] < 0.3]
    target = np.array(hulls[0].centre_m[:2])
    space = free_space(example)
    spots = space.centres_m()
    away = np.linalg.norm(spots - target, axis=1)
    start = spots[np.argmin(np.abs(away - 1.2))]
    heading = math.atan2(*(target - start)[::-1])
    simulation = Simulation(example, SMALL.model_copy(update={"render": False}), seed=1)
    simulation.reset(0, pose=(float(start[0]), float(start[1]), heading))
    ahead = simulation.ranges()[0]
    simulation.command(0.4, ttl_s=20.0)
    simulation.step(6.0)
    truth = simulation.truth()
    radius = simulation.settings.robot.body_radius_m
    gap = clearance_m(np.array([[truth.x_m, truth.y_m]]), footprints(parts, *BODY_BAND_M))[0]
    assert truth.collisions >= 1
    assert gap == pytest.approx(radius, abs=0.08)
    assert math.dist(start, (truth.x_m, truth.y_m)) < ahead
