"""Robots that share the tasks of a fleet in a generated office, all processes and rendered; gates nothing.

pytest -q -s tests/benchmarks/test_fleet_in_an_office.py
PLAN=offices-8-small ROBOTS=2,8 EXPLORED=/tmp/office pytest -q -s tests/benchmarks/test_fleet_in_an_office.py

EXPLORED keeps the map of the one robot that explores first, and takes it from there. Time is that of the
robots, not of the wall: in lockstep they wait for one another.
"""

import math
import os
import shutil
import time
from collections import Counter
from contextlib import ExitStack
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from services.launcher.client.maps import require_map
from services.launcher.client.queue import QueueClient
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.client.trail import collisions, driven_m
from shared.messages.simulation import Pose
from shared.messages.tasks import Task, TaskRequest
from shared.topics import STATUS
from shared.transport.keys import ANY
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.e2e.fleet import another_robot, dispatch_of_the_first, fleet_service, taking_part

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(7200)]

MAP = "office"
PLAN = os.environ.get("PLAN", "offices-3-medium")
ROBOTS = [int(count) for count in os.environ.get("ROBOTS", "1,4").split(",")]
TASKS = int(os.environ.get("TASKS", "40"))
SEED = int(os.environ.get("SEED", "1"))
STEPS, WAIT_S = 2000, 5400.0
APART_M = 3.0


@pytest.fixture(scope="module")
def explored(world, tmp_path_factory):
    """A data folder with the map of one robot that explored the office alone."""
    folder = Path(os.environ.get("EXPLORED") or tmp_path_factory.mktemp("explored"))
    if not (folder / "maps").exists():
        with ExitStack() as open_:
            stack = open_.enter_context(open_stack(StackChoice(folder, world, seed=1, lockstep=True)))
            robot = open_.enter_context(taking_part(stack, stack.robot))
            robot.client.wait_for_frame(robot.experimenter.reset(seed=1).stamp_ns)
            assert robot.run(action="explore", map=MAP, max_steps=20_000).succeeded
    return folder


def spread_out(space, count):
    """Poses of robots that begin, none near another."""
    rng, poses = np.random.default_rng(SEED), []
    while len(poses) < count:
        x_m, y_m, yaw_rad = space.random_pose(rng, 0.1)
        if all(math.dist((x_m, y_m), other[:2]) > APART_M for other in poses):
            poses.append((float(x_m), float(y_m), float(yaw_rad)))
    return poses


class Watched:
    """One robot while the fleet works: its missions, and its true way."""

    def __init__(self, robot):
        self.robot = robot
        self._statuses = robot.stack.bus.subscribe(STATUS, robot=robot.stack.robot)
        self.missions = set()

    def look(self):
        """Take what came."""
        self.robot.client.collect()
        self.missions |= {status.mission_id for status in self._statuses.take_all()}

    @property
    def truths(self):
        """True states so far."""
        return self.robot.client.trail.truths


def play(queue, robots, goals):
    """Hand all tasks to the fleet and wait for their ends; also how near two robots came."""
    for number, goal in enumerate(goals):
        goal_node = {"goal_node": int(goal)}
        task = Task(
            task_id=f"t{number:02}", robot=ANY, kind="goto", map=MAP, parameters=goal_node, max_steps=STEPS
        )
        queue.ask(TaskRequest(action="add", task=task))
    nearest_m, end_s, told = math.inf, time.monotonic() + WAIT_S, None
    while time.monotonic() < end_s and (told is None or told.tasks):
        time.sleep(0.3)
        for robot in robots:
            robot.look()
        spots = [(r.truths[-1].pose.x_m, r.truths[-1].pose.y_m) for r in robots if r.truths]
        nearest_m = min([nearest_m, *(math.dist(a, b) for a, b in combinations(spots, 2))])
        told = queue.ask(TaskRequest(action="read", ended=200))
    assert told is not None
    return [*told.tasks, *told.ended], nearest_m


@pytest.mark.parametrize("count", ROBOTS)
def test_a_fleet_does_the_tasks_of_an_office(count, world, explored, tmp_path, keep):
    shutil.copytree(explored / "maps", tmp_path / "maps")
    names = [f"r{number + 1}" for number in range(count)]

    def company(name):
        return ",".join(other for other in names if other != name)

    environment = {"FEATURES_ROBOTS": ",".join(names), "SIMULATOR_COMPANY": company("r1")}
    choice = StackChoice(tmp_path, world, seed=1, lockstep=True, environment=environment)
    with ExitStack() as open_:
        stack = open_.enter_context(open_stack(choice))
        for name in names[1:]:
            open_.enter_context(another_robot(stack, name, world, tmp_path, company(name)))
        robots = [Watched(open_.enter_context(taking_part(stack, name))) for name in names]
        for watched, pose in zip(robots, spread_out(free_space(load_world(world)), count), strict=True):
            x_m, y_m, yaw_rad = pose
            placed = watched.robot.experimenter.place_robot(Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad))
            watched.robot.client.wait_for_frame(placed.stamp_ns)
        open_.enter_context(dispatch_of_the_first(stack, tmp_path))
        open_.enter_context(fleet_service(stack, tmp_path))
        nodes = [node.node_id for node in require_map(stack, MAP).nodes]
        goals = np.random.default_rng(SEED).choice(nodes, TASKS)
        since_s, began_s = time.monotonic(), [watched.truths[-1].sim_time_s for watched in robots]
        tasks, nearest_m = play(QueueClient(stack.bus, ANY), robots, goals)
        ended_s = [watched.truths[-1].sim_time_s for watched in robots]
        keep(
            {
                "plan": PLAN,
                "robots": count,
                "tasks": Counter(task.failure or task.state for task in tasks),
                "time_s": max(np.subtract(ended_s, began_s)),
                "wall_s": time.monotonic() - since_s,
                "collisions": sum(collisions(watched.truths) for watched in robots),
                "driven_m": sum(driven_m(watched.truths) for watched in robots),
                "nearest_m": nearest_m if count > 1 else None,
                "away": sum(name.startswith("room-") for watched in robots for name in watched.missions),
            }
        )
