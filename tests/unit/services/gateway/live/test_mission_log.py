"""The file of missions survives what happens to files: half lines, restarts, years of use, full disks."""

from pathlib import Path

import pytest

from services.gateway.http.metrics import Metrics
from services.gateway.live import mission_log
from services.gateway.live.mission_log import FILE, MissionLog, read_missions
from shared.messages.missions import MissionStatus


def metrics() -> Metrics:
    return Metrics(lambda: {})


def finish(log: MissionLog, *names: str, **changes: object) -> None:
    """Let missions begin and end."""
    for name in names:
        for state in ("running", "succeeded"):
            facts = {"robot": "r1", "action": "goto", "map": "flat", **changes}
            log.take(MissionStatus(mission_id=name, state=state, **facts))  # type: ignore[arg-type]


def on_record(folder: Path) -> list[str]:
    return [entry.mission_id for entry in read_missions(folder / FILE)[0]]


def test_missions_are_read_as_they_were_written(tmp_path: Path) -> None:
    folder = tmp_path / "not" / "there yet"
    finish(MissionLog(folder, metrics()), "m1", "m2", reason="Gänge: 3\nüber")
    entries, broken = read_missions(folder / FILE)
    assert ([entry.mission_id for entry in entries], broken) == (["m1", "m2"], 0)
    assert entries[0].reason == "Gänge: 3\nüber"


def test_half_a_last_line_is_skipped_and_swallows_no_later_one(tmp_path: Path) -> None:
    finish(MissionLog(tmp_path, metrics()), "m1", "m2")
    path = tmp_path / FILE
    path.write_bytes(path.read_bytes()[:-30])
    assert [entry.mission_id for entry in read_missions(path)[0]] == ["m1"]
    finish(MissionLog(tmp_path, metrics()), "m3")
    assert on_record(tmp_path) == ["m1", "m3"]
    assert read_missions(path)[1] == 1


def test_a_mission_is_written_once_over_restarts_of_the_gateway(tmp_path: Path) -> None:
    for _ in range(3):
        finish(MissionLog(tmp_path, metrics()), "m1")
    assert on_record(tmp_path) == ["m1"]


def test_the_file_is_cut_back_to_the_newest(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mission_log, "KEPT", 3)
    monkeypatch.setattr(mission_log, "FULL", 6)
    log = MissionLog(tmp_path, metrics())
    finish(log, *(f"m{n}" for n in range(6)))
    assert len(on_record(tmp_path)) == 6
    finish(log, "m6")
    assert on_record(tmp_path) == ["m4", "m5", "m6"]
    finish(log, "m6", "m7")
    assert on_record(tmp_path) == ["m4", "m5", "m6", "m7"]
    assert [path.name for path in tmp_path.iterdir()] == [FILE]


def test_lines_from_before_a_restart_count_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mission_log, "KEPT", 2)
    monkeypatch.setattr(mission_log, "FULL", 4)
    for n in range(5):
        finish(MissionLog(tmp_path, metrics()), f"m{n}")
    assert on_record(tmp_path) == ["m3", "m4"]


def test_of_a_file_that_grew_too_long_the_end_is_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    finish(MissionLog(tmp_path, metrics()), *(f"m{n}" for n in range(10)))
    line = (tmp_path / FILE).stat().st_size // 10
    monkeypatch.setattr(mission_log, "MAX_BYTES", 3 * line + 10)
    assert on_record(tmp_path) == ["m7", "m8", "m9"]
    assert read_missions(tmp_path / FILE)[1] == 0


def test_a_folder_that_cannot_be_written_costs_the_record_only(tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file, no folder")
    counts = metrics()
    finish(MissionLog(tmp_path / "taken", counts), "m1")
    assert b"mission_records_lost_total 1.0" in counts.text()
