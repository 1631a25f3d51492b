"""Missions and commands as one list; what is broken is counted and hides nothing else."""

import json
import os
from datetime import UTC, datetime, timedelta
from pathlib import Path

import pytest

from services.gateway.live.mission_log import FILE
from services.gateway.live.mission_watch import MissionEntry
from services.gateway.routes.runs import MAX_FILE_BYTES, from_command, from_mission, list_runs, newest
from shared.runs import CommandRun

NOON = datetime(2026, 3, 1, 12, 0, tzinfo=UTC)


def mission(name: str, minute: int, **changes: object) -> MissionEntry:
    facts = {
        "mission_id": name, "robot": "r1", "kind": "explore", "map": "flat", "steps": 40,
        "nodes": 9, "edges": 8, "open_directions": 2, "similarity": 70, "outcome": "succeeded",
        "ended": NOON + timedelta(minutes=minute),
    }  # fmt: skip
    return MissionEntry.model_validate(facts | changes)


def command(minute: int, name: str = "explore", **changes: object) -> CommandRun:
    times = {"started": NOON, "ended": NOON + timedelta(minutes=minute)}
    return CommandRun.model_validate({"command": name, **times, **changes})


def keep(folder: Path, *runs: CommandRun) -> None:
    for run in runs:
        (folder / run.file_name).write_text(run.model_dump_json())


def test_a_mission_as_a_run() -> None:
    entry = mission("m1", 5, kind="goto", seed=3, outcome="failed", failure="lost", reason="no place")
    run = from_mission(entry)
    assert (run.id, run.source, run.kind, run.map, run.world) == (
        "mission:r1:m1",
        "mission",
        "goto",
        "flat",
        None,
    )
    assert (run.started, run.ended, run.outcome) == (None, NOON + timedelta(minutes=5), "failed")
    assert run.figures == {
        "steps": 40, "nodes": 9, "edges": 8, "open_directions": 2, "similarity": 70,
        "seed": 3, "failure": "lost", "reason": "no place",
    }  # fmt: skip


def test_a_mission_without_seed_or_reason_shows_none() -> None:
    assert not {"seed", "failure", "reason"} & from_mission(mission("m1", 5)).figures.keys()


def test_a_command_as_a_run() -> None:
    told = command(
        9, "study heading", world="village", map="v", seed=2, figures={"results": 7, "outcome": "odd"}
    )
    run = from_command("stamp-study-heading", told)
    assert (run.id, run.source, run.kind) == ("command:stamp-study-heading", "command", "study")
    assert run.title == "topnav study heading in village"
    assert (run.map, run.world, run.outcome, run.figures) == (
        "v",
        "village",
        "odd",
        {"results": 7, "seed": 2},
    )


def test_a_command_that_does_not_judge_itself_is_finished() -> None:
    run = from_command("x", command(9, "study heading"))
    assert (run.outcome, run.world, run.title) == ("finished", None, "topnav study heading")


def test_the_newest_come_first_from_both_sources(tmp_path: Path) -> None:
    lines = [mission("m1", 10), mission("m2", 30), mission("m3", 50)]
    (tmp_path / FILE).write_text("".join(f"{entry.model_dump_json()}\n" for entry in lines))
    keep(tmp_path, command(20), command(40), command(60))
    runs, broken = list_runs(tmp_path, 4)
    minutes = [(run.ended - NOON) // timedelta(minutes=1) for run in runs]
    assert (minutes, broken) == ([60, 50, 40, 30], 0)
    assert len({run.id for run in list_runs(tmp_path, 100)[0]}) == 6


def test_times_of_other_zones_are_sorted_by_the_moment() -> None:
    early = from_command("a", command(0, ended="2026-03-01T14:00:00+14:00"))
    late = from_command("b", command(0, ended="2026-03-01T01:00:00-11:00"))
    first = from_command("c", command(0, ended="0001-01-01T00:00:00+14:00"))
    assert newest([first, early, late], 9) == [late, early, first]


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"{",
        b"[]",
        b"null",
        b"\xff\xfe",
        b"[" * 5000,
        json.dumps({"command": "explore"}).encode(),
        command(1).model_dump_json().replace("explore", " ").encode(),
        command(1).model_dump_json().replace("12:01:00Z", "12:01:00").encode(),
        command(1).model_dump_json().replace('"figures":{}', '"figures":{"spl":NaN}').encode(),
        command(1).model_dump_json().replace('"figures":{}', '"figures":{"spl":null}').encode(),
        command(1).model_dump_json().replace('"world":""', '"world":"\\ud800"').encode(),
        command(1).model_dump_json().encode() + b" " * MAX_FILE_BYTES,
    ],
)
def test_a_broken_file_is_counted_and_left_out(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "99990101T000000Z-explore.json").write_bytes(content)
    keep(tmp_path, command(7))
    runs, broken = list_runs(tmp_path, 5)
    assert ([run.ended for run in runs], broken) == ([NOON + timedelta(minutes=7)], 1)


def test_a_folder_and_a_pipe_among_the_files_do_not_hold_up_the_list(tmp_path: Path) -> None:
    (tmp_path / "a.json").mkdir()
    os.mkfifo(tmp_path / "b.json")
    keep(tmp_path, command(7))
    runs, broken = list_runs(tmp_path, 5)
    assert (len(runs), broken) == (1, 2)


def test_an_unreadable_file_of_missions_hides_no_command(tmp_path: Path) -> None:
    (tmp_path / FILE).mkdir()
    keep(tmp_path, command(7))
    runs, broken = list_runs(tmp_path, 5)
    assert (len(runs), broken) == (1, 1)


@pytest.mark.parametrize("name", ["missing", "file"])
def test_without_a_folder_there_are_no_runs(tmp_path: Path, name: str) -> None:
    (tmp_path / "file").write_text("")
    assert list_runs(tmp_path / name, 5)[0] == []
