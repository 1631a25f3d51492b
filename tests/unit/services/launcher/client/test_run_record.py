"""What commands leave for the console's list of runs."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from services.gateway.routes.runs import list_runs
from services.launcher.client.run_record import keep_run
from shared.runs import CommandRun

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
