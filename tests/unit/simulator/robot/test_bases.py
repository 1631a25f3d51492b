"""Each base in physics does what its velocity says, as far as it can, and its wheels tell where it got to."""

import math

import pytest

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
