"""Lockstep: the same seed gives the same run, whatever the machine does meanwhile."""

import pytest

from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.exploration import explore
from tests.e2e.one_stack.conftest import MAP, STEPS, WORLD

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]


def edges_of(result):
    return [(e.a, e.b, e.raw_matches, e.inliers, e.heading_ab_rad) for e in result.graph.edges]


def test_another_stack_with_the_same_seed_makes_the_same_map_and_ends_at_the_same_place(explored, tmp_path):
    with open_stack(StackChoice(tmp_path, WORLD, seed=1, lockstep=True)) as stack:
        again = explore(stack, WORLD, MAP, seed=1, max_steps=STEPS)
    assert len(again.graph.nodes) == len(explored.result.graph.nodes) > 5
    assert edges_of(again) == edges_of(explored.result)
    for name in ("x_m", "y_m", "yaw_rad"):
        assert getattr(again.final, name) == pytest.approx(getattr(explored.result.final, name), abs=1e-6)
