"""What rounds come to, and how a suite tells it."""

from experiments.hide_and_seek.report import (
    combined,
    report,
    rounds_figures,
    suite_figures,
    suite_markdown,
    summary,
)


def one(success=True, **changes):
    figures = {
        "success": success, "final_distance_m": 0.1 if success else 4.0, "spl": 0.8 if success else 0.0,
        "steps": 100, "collisions": 0, "manual_moves": 0, "wall_s": 20.0, "path_ratio": 1.25,
        "edges_suspended": 1, "reason": "arrived" if success else "lost: no place",
        "failure": "" if success else "lost",
    }  # fmt: skip
    return figures | changes


def test_a_summary_counts_and_averages():
    told = summary([one(), one(path_ratio=1.75), one(success=False)])
    assert told["rounds"] == 3
    assert told["success_rate"] == 0.6667
    assert told["spl_mean"] == 0.5333
    assert told["path_ratio_median"] == 1.5
    assert told["final_distance_median_m"] == 0.1
    assert told["steps_per_s"] == 5.0
    assert told["edges_suspended"] == 3


def test_wrong_places_and_places_that_look_alike_are_counted_apart():
    told = summary(
        [one(), one(success=False, failure="wrong_place"), one(success=False, failure="ambiguous")]
    )
    assert (told["wrong_place"], told["ambiguous"]) == (1, 1)


def test_without_success_there_is_no_path_ratio():
    assert summary([one(success=False)])["path_ratio_median"] is None


def test_profiles_are_summed_apart():
    runs = [
        report("village", "default", 1, [one(), one()]),
        report("factory", "default", 1, [one()]),
        report("village", "thesis", 1, [one(success=False)]),
    ]
    told = combined(runs)
    assert {name: values["rounds"] for name, values in told.items()} == {"default": 3, "thesis": 1}


def test_the_markdown_names_what_was_not_found():
    run = report("a/attic.yaml", "default", 1, [one(), one(success=False)])
    run |= {
        "stages": {"render": {"p50_ms": 50.0}, "extract": {"p50_ms": 150.0}},
        "memory_mb": {"drive": 40.0},
    }
    explored = {
        "world": "a/attic.yaml", "nodes": 10, "edges": 20, "coverage": 0.97, "components": 1,
        "false_edges": 0, "collisions": 0, "manual_moves": 0, "steps": 500, "wall_s": 100.0,
        "bytes_per_node": 90_000,
    }  # fmt: skip
    text = suite_markdown("random", [explored], [run])
    assert "| attic | default | 1/2 |" in text
    assert "25%" in text
    assert "- attic, default, round 2: lost: no place (4.00 m left)" in text
    assert "| attic | 10 | 20 | 0.97 | 1 | 0 | 0 | 0 | 500 | 10 | 90 |" in text


def test_figures_of_rounds() -> None:
    assert rounds_figures([one(), one(success=False), one()]) == {
        "rounds": 3, "found": 2, "final_distance_median_m": 0.1, "spl_mean": 0.5333, "collisions": 0,
        "outcome": "succeeded",
    }  # fmt: skip
    assert rounds_figures([one(success=False)])["outcome"] == "failed"


def test_figures_of_a_suite_name_the_profile_only_where_there_are_several() -> None:
    runs = [{"profile": "default", "rounds": [one()]}, {"profile": "default", "rounds": [one(), one()]}]
    assert suite_figures(runs)["rounds"] == 3
    told = suite_figures([*runs, {"profile": "rules/strict.json", "rounds": [one(success=False)]}])
    assert (told["default: found"], told["strict: found"], told["strict: rounds"]) == (3, 0, 1)
