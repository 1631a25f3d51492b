"""Lockstep: the same seed gives the same run, whatever the machine does meanwhile."""

import numpy as np
import pytest

from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.exploration import explore
from tests.e2e.one_stack.conftest import MAP, STEPS, WORLD

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]


HALF = STEPS // 2
"""What differs at all differs soon."""


def edges_of(result):
    return {(e.a, e.b): (e.raw_matches, e.inliers, e.heading_ab_rad) for e in result.graph.edges}


def poses_of(result):
    return [(truth.pose.x_m, truth.pose.y_m, truth.pose.yaw_rad) for truth in result.run.truths[:HALF]]


def test_another_stack_with_the_same_seed_goes_the_same_way_and_makes_the_same_map(explored, tmp_path):
    with open_stack(StackChoice(tmp_path, WORLD, seed=1, lockstep=True)) as stack:
        again = explore(stack, WORLD, MAP, seed=1, max_steps=HALF)
    assert np.array(poses_of(again)) == pytest.approx(np.array(poses_of(explored.result)), abs=1e-6)
    assert len(again.graph.nodes) > 3
    assert edges_of(again).items() <= edges_of(explored.result).items()
