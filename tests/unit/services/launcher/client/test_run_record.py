"""What commands leave for the console's list of runs."""

from datetime import UTC, datetime
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from services.gateway.routes.runs import list_runs
from services.launcher.client.run_record import (
    explore_figures,
    keep_run,
    on_record,
    rounds_figures,
    suite_figures,
)
from shared.runs import CommandRun
from tests.unit.services.launcher.evaluation.test_report import one

STARTED = datetime(2026, 3, 1, 12, 0, tzinfo=UTC)


def records(data_dir: Path) -> list[CommandRun]:
    """All records, in the order of their names."""
    files = sorted((data_dir / "runs").iterdir())
    return [CommandRun.model_validate_json(path.read_bytes()) for path in files]


def test_a_record_says_what_was_run_and_where_the_rest_is(tmp_path: Path) -> None:
    keep_run(
        tmp_path,
        "explore",
        STARTED,
        {"nodes": 9},
        worlds=["worlds/flat.yaml", "village"],
        map_name="flat",
        seed=4,
        json_file=tmp_path / "x.json",
    )
    (record,) = records(tmp_path)
    assert record.started == STARTED < record.ended
    assert (record.command, record.world, record.map, record.seed) == ("explore", "flat, village", "flat", 4)
    assert (record.figures, record.file) == ({"nodes": 9}, str(tmp_path / "x.json"))


def test_the_gateway_lists_what_a_command_left(tmp_path: Path) -> None:
    keep_run(tmp_path, "hide-and-seek --suite thesis", STARTED, {"rounds": 14})
    (run,), broken = list_runs(tmp_path / "runs", 10)
    assert (run.kind, run.title, run.figures, broken) == (
        "hide-and-seek",
        "topnav hide-and-seek --suite thesis",
        {"rounds": 14},
        0,
    )


def test_runs_of_one_second_do_not_replace_each_other(tmp_path: Path) -> None:
    for number in range(4):
        keep_run(tmp_path, "explore", STARTED, {"nodes": number})
    assert sorted(record.figures["nodes"] for record in records(tmp_path)) == [0, 1, 2, 3]


@pytest.mark.parametrize("figures", [{"coverage": float("nan")}, {"nodes": 1}])
def test_a_record_that_cannot_be_written_is_a_warning(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], figures: dict[str, float]
) -> None:
    if figures == {"nodes": 1}:
        (tmp_path / "runs").write_text("a file, no folder")
    keep_run(tmp_path, "explore", STARTED, figures)
    assert "no record of this run" in capsys.readouterr().err


def test_figures_of_an_exploration() -> None:
    names = ("nodes", "edges", "coverage", "collisions", "false_edges", "steps", "steps_per_s", "outcome")
    report = dict.fromkeys(names, 1) | {"false_edge_list": [], "final_pose": {}}
    assert explore_figures(report) == dict.fromkeys(names, 1)


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


def test_a_study_keeps_its_options_and_leaves_a_record(tmp_path: Path) -> None:
    def main(world: str = "village", seed: int = 1, data_dir: Path = tmp_path) -> int:
        """Count."""
        assert (world, data_dir) == ("village", tmp_path)
        return seed + 1

    app = typer.Typer()
    app.command()(on_record("study counting", main))
    shown = CliRunner().invoke(app, ["--seed", "6", "--data-dir", str(tmp_path)])
    assert shown.exit_code == 0, shown.output
    (record,) = records(tmp_path)
    assert (record.command, record.world, record.seed) == ("study counting", "village", 6)
    assert record.figures == {"study": "counting", "results": 7}
    assert "Count." in CliRunner().invoke(app, ["--help"]).output


def test_a_study_without_a_data_folder_uses_the_usual_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("TOPNAV_DATA_DIR", str(tmp_path))
    on_record("study counting", lambda: 3)()
    assert records(tmp_path)[0].figures["results"] == 3


def test_a_study_that_fails_leaves_none(tmp_path: Path) -> None:
    def main(data_dir: Path) -> int:
        raise ValueError(data_dir)

    with pytest.raises(ValueError, match="pytest"):
        on_record("study failing", main)(data_dir=tmp_path)
    assert not (tmp_path / "runs").exists()
