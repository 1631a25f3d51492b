"""Nodes of a generated hostel, whose rooms are equal, driven to by number and by picture; gates nothing.

pytest -q -s tests/benchmarks/test_rooms_that_look_alike.py
PLAN=hostel-3-medium NODES=20 EXPLORED=/tmp/hostel pytest -q -s tests/benchmarks/test_rooms_that_look_alike.py

EXPLORED keeps the map, with the truth about it, and takes both from there.
"""

import math
import os
from collections import Counter
from contextlib import ExitStack
from pathlib import Path

import numpy as np
import pytest

from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.client.trail import collisions, driven_m, spl
from services.launcher.evaluation.exploration import explore
from services.launcher.evaluation.truth_file import load_truth, save_truth, truth_path
from shared.messages.maps import MapRequest
from shared.topics import MAP
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world
from tests.e2e.fleet import taking_part

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(7200)]

NAME = "hostel"
PLAN = os.environ.get("PLAN", "hostel-0-small")
NODES = int(os.environ.get("NODES", "12"))
SEED = int(os.environ.get("SEED", "1"))
FOUND_M, STEPS = 0.5, 1500


@pytest.fixture(scope="module")
def hostel(world, tmp_path_factory):
    """A running stack with the map of the hostel, and true poses of its nodes."""
    folder = Path(os.environ.get("EXPLORED") or tmp_path_factory.mktemp("explored"))
    file = truth_path(folder, NAME)
    with open_stack(StackChoice(folder, world, seed=1, lockstep=True)) as stack:
        if not file.exists():
            save_truth(file, NAME, explore(stack, world, NAME, 1, 20_000).truth)
        yield stack, load_truth(file).poses


def goal_of(stack, node, way):
    """What a mission to a node is asked for."""
    if way == "node":
        return {"parameters": {"goal_node": node}}
    read = MapRequest(action="read_features", node_ids=(node,))
    return {"goal": stack.bus.ask(MAP, read, 10.0, map=NAME).features[0].features}


@pytest.mark.parametrize("way", ["node", "picture"])
def test_nodes_are_driven_to_one_after_the_other(way, hostel, world, keep):
    stack, poses = hostel
    space = free_space(load_world(world))
    goals = [int(node) for node in np.random.default_rng(SEED).permutation(sorted(poses))[:NODES]]
    figures = {"ended": Counter(), "left_m": [], "spl": [], "collisions": 0, "driven_m": 0.0, "wall_s": 0.0}
    with ExitStack() as open_:
        robot = open_.enter_context(taking_part(stack, stack.robot))
        robot.client.wait_for_frame(robot.experimenter.reset(seed=1).stamp_ns)
        for node in goals:
            run = robot.run(action="goto", map=NAME, max_steps=STEPS, **goal_of(robot.stack, node, way))
            spots = [(truth.pose.x_m, truth.pose.y_m) for truth in run.truths]
            goal = (poses[node].x_m, poses[node].y_m)
            left_m, way_m = math.dist(spots[-1], goal), driven_m(run.truths)
            found = run.succeeded and left_m <= FOUND_M
            figures["ended"]["found" if found else run.status.failure or "elsewhere"] += 1
            figures["left_m"].append(left_m)
            figures["spl"].append(spl(found, max(space.shortest_path_m(spots[0], goal), 0.01), way_m))
            figures["collisions"] += collisions(run.truths)
            figures["driven_m"] += way_m
            figures["wall_s"] += run.wall_s
    figures["left_m"] = float(np.median(figures["left_m"]))
    figures["spl"] = float(np.mean(figures["spl"]))
    keep({"plan": PLAN, "nodes": len(goals), **figures})
