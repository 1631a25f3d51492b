"""The disturbance study: what is left to run, what it writes, and going on with a file."""

import json

import pytest

from experiments.commands import disturbance
from experiments.driving import disturbance as driven
from experiments.driving.disturbance import draw_curves, level_row, settings_to_run
from experiments.rendered.disturbed import CLEAN
from experiments.work.results_file import ResultsFile
from services.launcher.client.failure import ExperimentError

SETUP = {"world": "plain", "seed": 1}


def figures(success, spl=0.8, failure=""):
    return {
        "success": success, "spl": spl, "failure": failure, "final_distance_m": 0.1, "collisions": 0,
        "manual_moves": 0, "steps": 50, "wall_s": 5.0, "path_ratio": 1.2, "edges_suspended": 0,
    }  # fmt: skip


def test_a_level_has_the_fixed_keys_and_counts_failures():
    row = level_row("fog", 0.5, [figures(True), figures(False, 0.0, "lost"), figures(False, 0.0, "lost")])
    assert list(row)[:5] == ["disturbance", "level", "success_rate", "spl_mean", "rounds"]
    assert (row["success_rate"], row["spl_mean"], row["rounds"]) == (0.3333, 0.2667, 3)
    assert row["failures"] == {"lost": 2}


def test_clean_level_is_run_once_and_first():
    todo = settings_to_run(["fog", "noise"], [0.5, 0.0], [])
    assert [(t["disturbance"], t["level"]) for t in todo] == [(CLEAN, 0.0), ("fog", 0.5), ("noise", 0.5)]


@pytest.fixture
def study(monkeypatch, tmp_path):
    """The command with levels that are played by nobody; returns how to run it, and what was played."""
    played = []

    def run_level(_, name, level):
        if len(played) == run.fails_after:
            raise ExperimentError("stopped")
        played.append((name, level))
        return level_row(name, level, [figures(True)])

    def run(**given):
        disturbance.disturbance(
            world="apartment", map_name="flat", only="fog,noise", levels="0,0.5", rounds=1, seed=1,
            max_steps=100, json_file=tmp_path / "f.json", plot=tmp_path / "f.png", data_dir=tmp_path,
            **given,
        )  # fmt: skip

    run.fails_after = None
    monkeypatch.setattr(driven, "run_level", run_level)
    return run, played, tmp_path


def test_study_goes_on_where_its_file_stopped(study):
    run, played, folder = study
    run.fails_after = 2
    with pytest.raises(ExperimentError, match="stopped"):
        run()
    assert len(json.loads((folder / "f.json").read_text())["results"]) == 2
    run.fails_after = None
    run()
    assert played == [(CLEAN, 0.0), ("fog", 0.5), ("noise", 0.5)]
    results = json.loads((folder / "f.json").read_text())["results"]
    assert [(r["disturbance"], r["level"]) for r in results] == played
    assert (folder / "f.png").stat().st_size > 5000
    run()
    assert len(played) == 3


def test_file_of_another_setup_is_refused(tmp_path):
    path = tmp_path / "f.json"
    ResultsFile(path, SETUP).add(level_row("fog", 0.5, [figures(True)]))
    assert len(ResultsFile(path, SETUP).results) == 1
    with pytest.raises(ExperimentError, match="was written with"):
        ResultsFile(path, {**SETUP, "seed": 2})
    path.write_text("[]")
    with pytest.raises(ExperimentError, match="no file of this study"):
        ResultsFile(path, SETUP)


@pytest.mark.parametrize(("only", "levels"), [("fog,snow", "0"), ("", "0"), ("fog", "2"), ("fog", "a")])
def test_wrong_options_are_refused(only, levels, tmp_path):
    with pytest.raises(ExperimentError, match=r"--only|--levels"):
        disturbance.disturbance(only=only, levels=levels, data_dir=tmp_path)


def test_curves_are_drawn_with_only_the_clean_result(tmp_path):
    draw_curves(tmp_path / "c.png", [level_row(CLEAN, 0.0, [figures(True)])])
    assert (tmp_path / "c.png").stat().st_size > 3000
