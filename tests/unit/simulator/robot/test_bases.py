"""Each base in physics does what its velocity says, as far as it can, and its wheels tell where it got to."""

import math

import pytest

from simulator.disturbances.levels import Disturbances
from simulator.settings import RobotSettings, SimulationSettings
from simulator.simulation import Simulation


@pytest.mark.parametrize("base", ["holonomic", "differential", "ackermann"])
@pytest.mark.parametrize("turn_radps", [0.0, 0.5])
def test_a_velocity_is_followed_and_its_wheels_tell_the_way(room, base, turn_radps):
    settings = SimulationSettings(render=False, robot=RobotSettings(base=base))
    simulation = Simulation(room, settings)
    simulation.reset(0, (1.0, 1.0, 0.0))
    simulation.command(0.3, 0.0, turn_radps)
    simulation.step(3.0)
    truth, (way, _) = simulation.truth(), simulation.odometry()
    assert truth.collisions == 0
    assert truth.yaw_rad == pytest.approx(3.0 * turn_radps, abs=0.2)
    assert math.dist((truth.x_m - 1.0, truth.y_m - 1.0), (way.x_m, way.y_m)) < 0.06
    assert way.turn_rad == pytest.approx(truth.yaw_rad, abs=0.1)


def driven(room, levels, velocity, seed=3):
    settings = SimulationSettings(render=False, disturbances=Disturbances(**levels))
    simulation = Simulation(room, settings)
    simulation.reset(seed, (1.0, 1.0, 0.0))
    for _ in range(10):
        simulation.command(*velocity)
        simulation.step(0.3)
    return simulation


def test_wheels_that_slip_roll_further_than_the_robot_gets(room):
    simulation = driven(room, {"slip": 1.0}, (0.3, 0.1, 0.0))
    truth, (way, _) = simulation.truth(), simulation.odometry()
    got_m, rolled_m = math.dist((truth.x_m, truth.y_m), (1.0, 1.0)), math.hypot(way.x_m, way.y_m)
    assert rolled_m == pytest.approx(3.0 * math.hypot(0.3, 0.1), rel=0.08)
    assert 0.7 < got_m / rolled_m < 0.95
    grips = driven(room, {}, (0.3, 0.1, 0.0)).truth()
    assert math.dist((grips.x_m, grips.y_m), (1.0, 1.0)) == pytest.approx(rolled_m, rel=0.08)


def test_motors_with_a_deadband_do_not_start_for_a_slow_velocity(room):
    slow, fast = (driven(room, {"deadband": 1.0}, (v, 0.0, 0.0)).truth() for v in (0.08, 0.2))
    assert slow.x_m == pytest.approx(1.0, abs=0.01)
    assert fast.x_m == pytest.approx(1.6, abs=0.1)
