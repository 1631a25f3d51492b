"""What a suite of generated worlds comes to."""

import pytest

from experiments.generated.plan import WorldPlan
from experiments.generated.report import failures, page, summary
from experiments.generated.row import curves_of, world_row
from simulator.world.freespace import free_space
from simulator.world.world_file import load_world

WORLD = load_world("apartment")
SPACE = free_space(WORLD)
ROUND = {
    "success": True, "final_distance_m": 0.05, "spl": 0.9, "reason": "arrived at the goal", "failure": "",
    "steps": 60, "collisions": 0, "shortest_m": 3.0,
}  # fmt: skip
LOST = {
    **ROUND,
    "success": False,
    "final_distance_m": 4.0,
    "spl": 0.0,
    "failure": "lost",
    "reason": "lost: why",
}


def explored(**changes):
    figures = {
        "coverage": 0.99, "driven_m": 100.0, "steps": 900, "nodes": 20, "edges": 60, "components": 1,
        "false_edges": 0, "collisions": 0, "outcome": "succeeded", "reason": "no frontier is left",
        "coverage_curve": [[0.0, 0.2], [60.0, 0.97], [90.0, 0.99]],
    }  # fmt: skip
    return {**figures, **changes}


def row(rounds=(ROUND, LOST), moved=(ROUND,), **changes):
    plan, figures = WorldPlan("flat", 0, "small", 2, 100), explored(**changes)
    curves = curves_of(plan, WORLD, SPACE, figures)
    return world_row(plan, SPACE, figures, curves, rounds, moved)


def test_a_row_has_what_others_read_from_it():
    one = row()
    assert (one["kind"], one["ended"], one["metres"]) == ("flat", True, 60.0)
    assert one["peer_metres"] < one["walk_metres"]
    assert [played["success"] for played in one["rounds"]] == [True, False]


def test_the_summary_counts_worlds_rounds_and_metres():
    total = summary([row(), row(coverage=0.5, coverage_curve=[[0.0, 0.5]], false_edges=2, outcome="failed")])
    assert (total["worlds"], total["coverage_ok"], total["ended"]) == (2, 1, 1)
    assert (total["false_edges"], total["without_false_edges"], total["edges"]) == (2, 1, 120)
    assert (total["success_rate"], total["moved_success_rate"]) == (0.5, 1.0)
    assert total["metres_over_peer_median"] == pytest.approx(60.0 / row()["peer_metres"], abs=1e-3)


def test_failures_stand_by_their_cause_with_the_recording_to_look_at():
    found = failures(
        [row(collisions=1, moved=(LOST,)), {**row(), "rounds": [], "moved": [], "coverage": 0.9}]
    )
    assert found["coverage"] == ["flat-0-small: 0.900"]
    assert found["collision while exploring"] == ["flat-0-small: 1"]
    assert found["lost (as mapped)"][0].endswith("flat-0-small/flat-0-small-default-1/round-02.mcap")
    assert found["lost (rearranged)"][0].endswith("flat-0-small-rearranged-default-1/round-01.mcap")


def test_a_world_whose_stack_failed_is_told_and_counts():
    broken = {"kind": "shop", "seed": 3, "size": "large", "error": "no frame of r1"}
    total = summary([broken, row()])
    assert (total["worlds"], total["errors"], total["coverage_ok"]) == (2, 1, 1)
    text = page("validation", [broken, row()], total)
    assert "no frame of r1" in text
    assert "## stack failed: 1" in text


def test_without_rounds_there_are_no_shares():
    total = summary([row(rounds=(), moved=())])
    assert total["success_rate"] is total["moved_success_rate"] is total["spl_mean"] is None
