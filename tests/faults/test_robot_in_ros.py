"""A robot that only ROS 2 reaches explores and finds a picture: rclpy, services/ros and the guard."""

from collections.abc import Iterator

import numpy as np
import pytest

from experiments.ros_robot.robot import RosRobot, running_stack
from services.launcher.client.stack import Stack, StackChoice
from services.launcher.client.trail import collisions
from services.launcher.evaluation.exploration import explore, figures
from services.launcher.evaluation.rounds import Game
from shared.bus import wait_until
from shared.topics import FRAME, IMU, ODOMETRY
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.e2e.near_node import hiding_place_near_a_node
from tests.integration.ros.conftest import ROS_PYTHON
from tests.theta_robot import IN_ROS, domain

pytestmark = [*IN_ROS, pytest.mark.timeout(900)]

WORLD = "apartment"
STEPS = 90
SMALL_PICTURES = {"SIMULATOR_WIDTH_PX": "1024"}
SOON_S = 30.0


@pytest.fixture
def stack(tmp_path) -> Iterator[Stack]:
    """A stack whose robot is in ROS."""
    robot = RosRobot(tmp_path / "robot", WORLD, 1, domain(), ROS_PYTHON, SMALL_PICTURES)
    with running_stack(robot, StackChoice(tmp_path / "data", seed=1)) as opened:
        yield opened


def test_it_explores_and_finds_a_picture(stack):
    assert "simulator" not in stack.launcher.status()
    heard = {topic: stack.bus.subscribe(topic, robot=stack.robot) for topic in (FRAME, IMU, ODOMETRY)}
    space = free_space(load_world(WORLD))
    explored = explore(stack, WORLD, "ros", seed=1, max_steps=STEPS)
    assert heard[FRAME].take().encoding == "jpeg"
    assert heard[IMU].take().gravity[2] < -0.99
    assert heard[ODOMETRY].take_all()
    assert len(explored.graph.nodes) > 3
    assert figures(explored, space, "ros", 1)["false_edges"] == 0
    game = Game(stack, space, "ros", np.random.default_rng(1))
    start = game.begin(seed=1).pose
    played = game.seek(start, hiding_place_near_a_node(explored, space, start), seed=2, max_steps=300)
    assert played.success, played.run.status.reason
    assert collisions([*explored.run.truths, *played.run.truths]) == 0
    assert wait_until(lambda: stack.bus.alive("ros") == ["ros"], SOON_S)
