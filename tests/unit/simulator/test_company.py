"""Other robots of a place are where their simulators say: felt and hit, but never put into one another."""

import math

import numpy as np
import pytest

from simulator.company import FOLLOW_MPS, PUT_M, company_of
from simulator.settings import RangeSettings, RobotSettings, SimulationSettings
from simulator.simulation import Simulation

HERE, THERE = (0.0, 0.0), (2.0, 1.0, 0.5)
RADIUS_M = RobotSettings().body_radius_m
AHEAD_M = 1.2


@pytest.fixture
def company():
    return company_of(("r2", "r3"), RobotSettings())


def where(company, steps=1, dt_s=0.01, own=HERE):
    for _ in range(steps):
        company.advance(dt_s, own)
    return company.poses()


def test_one_of_which_nothing_was_heard_is_nowhere(company):
    assert where(company) == [None, None]
    assert len(company.outlines().disc_radii_m) == 0


def test_one_that_was_put_somewhere_is_there_at_once_and_gone_when_nothing_is_heard_of_it(company):
    company.tell("r3", THERE)
    assert where(company) == [None, THERE]
    assert company.outlines().disc_centres_m.tolist() == [[2.0, 1.0]]
    company.tell("r3", None)
    assert where(company) == [None, None]


def test_one_that_drives_is_followed_no_faster_than_a_robot_goes(company):
    company.tell("r2", THERE)
    where(company)
    company.tell("r2", (2.0 + 0.9 * PUT_M, 1.0, 0.5 - 1.0))
    x_m, y_m, yaw_rad = where(company)[0]
    assert (x_m, y_m) == pytest.approx((2.0 + 0.01 * FOLLOW_MPS, 1.0))
    assert 0.4 < yaw_rad < 0.5
    np.testing.assert_allclose(where(company, 60)[0], (2.0 + 0.9 * PUT_M, 1.0, -0.5))


def test_it_turns_the_short_way(company):
    company.tell("r2", (2.0, 1.0, 3.1))
    where(company)
    company.tell("r2", (2.0, 1.0, -3.1))
    assert where(company, 50)[0][2] == pytest.approx(math.tau - 3.1)


def test_one_that_stands_where_this_robot_was_put_is_nowhere_until_they_are_apart(company):
    company.tell("r2", (0.3, 0.0, 0.0))
    assert where(company)[0] is None
    assert where(company, own=(-0.15, 0.0))[0] is None
    assert where(company, own=(-0.25, 0.0))[0] == (0.3, 0.0, 0.0)
    assert where(company, own=(-0.15, 0.0))[0] is not None, "now it is touched"
    company.withdraw((0.1, 0.0))
    assert company.poses()[0] is None


def test_a_robot_that_nobody_named_is_an_error(company):
    with pytest.raises(KeyError):
        company.tell("r4", THERE)


@pytest.fixture
def shared_room(room):
    settings = SimulationSettings(render=False, ranges=RangeSettings(noise_m=0.0), company=("r2",))
    return Simulation(room, settings, seed=3)


def test_distance_sensors_feel_the_other_robot(shared_room, simulation):
    alone_m = simulation.ranges()
    np.testing.assert_allclose(shared_room.ranges(), alone_m, atol=1e-4)
    shared_room.tell_company("r2", (2.0 + AHEAD_M, 2.0, 0.0))
    shared_room.step(0.01)
    felt_m = shared_room.ranges()
    assert felt_m[0] == pytest.approx(AHEAD_M - RADIUS_M, abs=0.05)
    np.testing.assert_allclose(felt_m[3:10], alone_m[3:10], atol=1e-4)
    shared_room.tell_company("r2", None)
    shared_room.step(0.01)
    np.testing.assert_allclose(shared_room.ranges(), alone_m, atol=1e-4)


def test_who_drives_into_the_other_robot_is_stopped_and_has_collided(shared_room):
    shared_room.tell_company("r2", (2.0 + AHEAD_M, 2.0, 0.0))
    shared_room.command(0.5)
    shared_room.step(5.0)
    truth = shared_room.truth()
    assert truth.collisions > 0
    assert math.hypot(truth.x_m - 2.0 - AHEAD_M, truth.y_m - 2.0) > 2 * RADIUS_M - 0.03


def test_two_that_start_at_one_spot_part_without_a_collision(shared_room):
    start = shared_room.truth()
    shared_room.tell_company("r2", (start.x_m, start.y_m, 0.0))
    shared_room.command(-0.4)
    shared_room.step(3.0)
    assert shared_room.truth().collisions == 0
    assert shared_room.ranges()[0] < 1.0, "seen once they are apart"
