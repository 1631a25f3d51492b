"""Where the robot's links are before it has moved: pictures are taken then, too."""

import math

import pytest

from simulator.settings import SimulationSettings
from simulator.simulation import Simulation


def test_legs_and_wheels_are_below_the_robot_before_the_first_step(room):
    simulation = Simulation(room, SimulationSettings(render=False))
    simulation.place_robot(3.0, 1.0, 0.5)
    links = simulation._physics.robot.links
    assert len(links) == 9
    for link in links.values():
        assert math.dist(link.entity.pose.p[:2], (3.0, 1.0)) < 0.2
    assert links["wheel0"].entity.pose.p[2] == pytest.approx(0.08)
