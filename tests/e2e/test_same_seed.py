"""Lockstep: the same seed gives the same run, whatever the machine does meanwhile."""

import pytest

from services.launcher.client.stack import StackChoice, open_stack
from services.launcher.evaluation.exploration import explore

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(900)]

STEPS = 150


def run(data_dir):
    with open_stack(StackChoice(data_dir, "apartment", seed=3, lockstep=True)) as stack:
        result = explore(stack, "apartment", "same", seed=3, max_steps=STEPS)
    edges = [(e.a, e.b, e.raw_matches, e.inliers, e.heading_ab_rad) for e in result.graph.edges]
    return len(result.graph.nodes), edges, result.final


def test_two_runs_of_one_seed_make_the_same_map_and_end_at_the_same_place(tmp_path):
    (nodes, edges, final), (nodes_again, edges_again, final_again) = run(tmp_path / "a"), run(tmp_path / "b")
    assert nodes > 5
    assert nodes_again == nodes
    assert edges_again == edges
    for name in ("x_m", "y_m", "yaw_rad"):
        assert getattr(final_again, name) == pytest.approx(getattr(final, name), abs=1e-6)
