"""Two robots that see and feel each other map one flat and drive through it at once; gates nothing.

pytest -q -s tests/benchmarks/test_robots_in_one_place.py
FLEET=0 pytest -q -s tests/benchmarks/test_robots_in_one_place.py  # without rights of way
"""

import os
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack

import numpy as np
import pytest

from services.launcher.client.maps import require_map
from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.client.trail import collisions
from shared.messages.simulation import Pose
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.e2e.fleet import another_robot, fleet_service, taking_part

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(3600)]

WORLD, MAP, FIRST, SECOND = "apartment", "flat", "r1", "r2"
STEPS = int(os.environ.get("STEPS", "150"))
RIGHTS_OF_WAY = os.environ.get("FLEET", "1") == "1"
GOALS = int(os.environ.get("GOALS", "5"))


def apart(start, rng):
    """A free pose at least 2 m from a start."""
    space = free_space(load_world(WORLD))
    while True:
        x_m, y_m, yaw_rad = space.random_pose(rng, 0.1)
        if np.hypot(x_m - start[0], y_m - start[1]) > 2.0:
            return Pose(x_m=x_m, y_m=y_m, yaw_rad=yaw_rad)


def test_two_robots_in_one_flat(tmp_path, keep):
    rng = np.random.default_rng(1)
    environment = {"FEATURES_ROBOTS": f"{FIRST},{SECOND}", "SIMULATOR_COMPANY": SECOND}
    choice = StackChoice(tmp_path, WORLD, seed=1, lockstep=True, environment=environment)
    with ExitStack() as open_:
        stack = open_.enter_context(open_stack(choice))
        open_.enter_context(another_robot(stack, SECOND, WORLD, tmp_path, FIRST))
        if RIGHTS_OF_WAY:
            open_.enter_context(fleet_service(stack, tmp_path))
        robots = [open_.enter_context(taking_part(stack, name)) for name in (FIRST, SECOND)]
        threads = open_.enter_context(ThreadPoolExecutor(2))
        first, second = robots
        first.client.wait_for_frame(first.experimenter.reset(seed=1).stamp_ns)
        start = load_world(WORLD).start
        pose = apart((start.x_m, start.y_m), rng)
        second.client.wait_for_frame(second.experimenter.place_robot(pose).stamp_ns)
        first.run(action="explore", map=MAP, max_steps=40)
        list(threads.map(lambda each: each.run(action="explore", map=MAP, max_steps=STEPS), robots))
        nodes = [node.node_id for node in require_map(stack, MAP).nodes]
        ends = []
        for _ in range(GOALS):
            goals = rng.choice(nodes, 2, replace=False)
            ends += threads.map(
                lambda each, goal: each.run(action="goto", map=MAP, goal_node=int(goal), max_steps=400),
                robots,
                goals,
            )
        for each in robots:
            each.client.collect()
        keep(
            {
                "nodes": len(nodes),
                "reached": sum(run.status.state == "succeeded" for run in ends),
                "of": len(ends),
                "why": [run.status.failure for run in ends if run.status.state != "succeeded"],
                "steps": [sum(run.status.step for run in each.runs) for each in robots],
                "collisions": [collisions(each.client.trail.truths) for each in robots],
            }
        )
