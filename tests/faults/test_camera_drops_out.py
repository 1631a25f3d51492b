"""A base in ROS 2 with a camera over wifi, as a TurtleBot 4 with a THETA: late pictures, and a drop-out."""

import threading
import time
from collections.abc import Iterator

import numpy as np
import pytest

from services.launcher.client.trail import collisions
from services.launcher.evaluation.exploration import explore
from services.launcher.evaluation.rounds import Game
from shared.bus import wait_until
from shared.topics import CAMERA_STATE, EVENT
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.e2e.near_node import hiding_place_near_a_node
from tests.faults.watching import Watch
from tests.osc_camera import OscCamera
from tests.theta_robot import IN_ROS, WORLD, ThetaRobot, theta_robot

pytestmark = [*IN_ROS, pytest.mark.timeout(900)]

STEPS = 90
UNPLUGGED_S = 10.0
STOP_S, SEEN_S = 0.5, 0.5
"""From the last picture's heading to a word to stand; deceleration, and a machine that does other things."""
LAST_PICTURE_S = 1.5
"""Within so long the last picture has become a heading, on a machine that does other things."""
MOVES_S = 60.0


@pytest.fixture
def robot(tmp_path) -> Iterator[ThetaRobot]:
    """The robot in the apartment."""
    with theta_robot(tmp_path, width_px=1024) as opened:
        yield opened


class DropOut(threading.Thread):
    """Takes the camera's battery out while the robot drives, once, and puts it back."""

    def __init__(self, camera: OscCamera, watch: Watch) -> None:
        super().__init__(daemon=True)
        self._camera, self._watch = camera, watch
        self.at_s: float | None = None
        self.back_s = 0.0

    def run(self) -> None:
        since_s = time.monotonic()
        if wait_until(lambda: self._watch.moving(since_s), MOVES_S):
            self.at_s = time.monotonic()
            self._camera.unplug()
            time.sleep(UNPLUGGED_S)
            self._camera.plug()
            self.back_s = time.monotonic()


def test_it_stands_while_its_camera_is_gone_and_finds_the_picture_afterwards(robot, record_property):
    stack, space = robot.stack, free_space(load_world(WORLD))
    states = stack.bus.subscribe(CAMERA_STATE, robot=stack.robot)
    explored = explore(stack, WORLD, "theta", seed=1, max_steps=STEPS)
    assert len(explored.graph.nodes) > 3
    assert states.take().model == robot.camera.model
    events = stack.bus.subscribe(EVENT, robot=stack.robot)
    game = Game(stack, space, "theta", np.random.default_rng(1))
    start = game.begin(seed=1).pose
    with Watch(stack.endpoint, stack.robot) as watch:
        gone = DropOut(robot.camera, watch)
        gone.start()
        hider = hiding_place_near_a_node(explored, space, start)
        played = game.seek(start, hider, seed=2, max_steps=400)
        gone.join()
        assert gone.at_s is not None, "it never drove"
        headed_s = [at_s for at_s, _ in watch.headings if at_s < gone.at_s + LAST_PICTURE_S]
        stood_s = watch.still_after_s(headed_s[-1])
        record_property("stood_after_heading_s", stood_s)
        record_property("stood_after_unplugging_s", watch.still_after_s(gone.at_s))
        told_s = watch.told_to_stand_s(headed_s[-1])
        assert told_s is not None
        assert told_s - headed_s[-1] <= STOP_S
        assert stood_s is not None
        assert stood_s <= STOP_S + SEEN_S
        assert watch.fastest_mps(gone.back_s) > 0.1  # it drove on
        still = [speed for at_s, speed in watch.speeds if headed_s[-1] + 1.0 < at_s < gone.back_s]
        assert max(still) < 0.03
    assert played.success, [f"{event.step} {event.kind}: {event.reason}" for event in events.take_all()]
    assert collisions([*explored.run.truths, *played.run.truths]) == 0
