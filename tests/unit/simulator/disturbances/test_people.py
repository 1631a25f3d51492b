"""Walkers keep to free floor, out of each other's way and out of the robot's."""

import math

import numpy as np
import pytest

from simulator.disturbances.levels import Disturbances
from simulator.disturbances.walking import GAP_M, crowd_of
from simulator.settings import RangeSettings, SimulationSettings
from simulator.simulation import Simulation
from simulator.world.footprints import clearance_m, footprints
from simulator.world.freespace import BODY_BAND_M, free_space
from simulator.world.world_file import WorldFile

FAR = (1e3, 1e3)
DT_S = 0.05


@pytest.fixture(scope="module")
def hall(room_data) -> WorldFile:
    """A hall of 9 x 7 m with the table in its middle."""
    rooms = [{**room_data["rooms"][0], "x_m": [0, 9], "y_m": [0, 7]}]
    return WorldFile.model_validate({**room_data, "rooms": rooms})


@pytest.fixture(scope="module")
def space(hall):
    return free_space(hall)


@pytest.fixture
def crowd(space):
    return crowd_of(space, 1.0, 5)


@pytest.fixture(scope="module")
def busy(hall):
    settings = SimulationSettings(
        render=False, ranges=RangeSettings(noise_m=0.0), disturbances=Disturbances(people=1.0)
    )
    return Simulation(hall, settings, seed=5)


def test_level_zero_has_nobody_and_more_level_has_more(space):
    assert [len(crowd_of(space, level, 5).walkers) for level in (0.0, 0.2, 1.0)] == [0, 1, 4]


def test_nobody_ever_touches_furniture_or_each_other(hall, crowd):
    from simulator.world.contents import expand

    standing = footprints(expand(hall)[0], *BODY_BAND_M)
    nearest = math.inf
    for _ in range(800):
        crowd.advance(DT_S, FAR)
        places = np.array([walker.pose()[:2] for walker in crowd.walkers])
        radii = [walker.figure.radius_m for walker in crowd.walkers]
        assert (clearance_m(places, standing) >= radii).all()
        for k, walker in enumerate(crowd.walkers):
            for other in crowd.walkers[:k]:
                gap = math.dist(walker.pose()[:2], other.pose()[:2])
                nearest = min(nearest, gap - walker.figure.radius_m - other.figure.radius_m)
    assert nearest > 0.0


def test_same_seed_walks_the_same_way(space):
    def walk(seed):
        crowd = crowd_of(space, 1.0, seed)
        for _ in range(100):
            crowd.advance(DT_S, FAR)
        return [walker.pose() for walker in crowd.walkers]

    assert walk(5) == walk(5)
    assert walk(5) != walk(6)


def test_walker_waits_for_the_robot_and_then_turns_back(space):
    crowd = crowd_of(space, 0.2, 5)
    (walker,) = crowd.walkers
    robot = walker.point(walker.along_m + 3.0)
    reach_m = walker.figure.radius_m + space.robot_radius_m
    gaps, directions = [], set()
    for _ in range(600):
        crowd.advance(DT_S, robot)
        gaps.append(math.dist(walker.pose()[:2], robot) - reach_m)
        directions.add(walker.direction)
    assert min(gaps) >= GAP_M - 0.01
    assert directions == {1, -1}


def test_impolite_walker_does_not_care(space):
    crowd = crowd_of(space, 0.2, 5, polite=False)
    (walker,) = crowd.walkers
    robot = walker.point(walker.along_m + 1.0)
    gaps = []
    for _ in range(100):
        crowd.advance(DT_S, robot)
        gaps.append(math.dist(walker.pose()[:2], robot))
    assert min(gaps) < 0.1


def test_standing_robot_is_never_hit(busy):
    busy.reset(1)
    busy.step(40.0)
    assert busy.truth().collisions == 0
    assert math.hypot(busy.truth().x_m - 2.0, busy.truth().y_m - 2.0) < 0.01


def test_sonar_sees_a_person_and_the_robot_bumps_into_it(busy):
    walker = busy._crowd.walkers[0]
    busy.reset(1)
    walker = busy._crowd.walkers[0]
    x_m, y_m, _ = walker.pose()
    busy.place_robot(x_m - 1.2, y_m, 0.0)
    assert math.dist(busy._crowd.walkers[0].pose()[:2], (x_m, y_m)) < 1e-9
    assert busy.ranges()[0] == pytest.approx(1.2 - 0.24, abs=0.05)
    walker.figure = type(walker.figure)(walker.figure.looks, walker.figure.solid, 0.26, 0.0)
    busy.command(0.48)
    busy.step(4.0)
    assert busy.truth().collisions == 1
    assert busy.truth().x_m < x_m - 0.4


def test_people_walk_the_same_in_every_run(busy):
    def run():
        busy.reset(7)
        readings = []
        for k in range(10):
            busy.command(0.32 * math.cos(0.5 * k), 0.32 * math.sin(0.5 * k), ttl_s=0.3)
            busy.step(0.3)
            readings.append(tuple(busy.ranges()))
        return busy.truth(), readings

    assert run() == run()
