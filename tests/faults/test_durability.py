"""Nothing acknowledged is lost by kill -9 at any moment, and no changed byte that is used goes unnoticed."""

from collections.abc import Callable
from pathlib import Path

import pytest

from tests.faults.flips import flips
from tests.faults.kills import kill_often

KILLS, FLIPS = 12, 60


@pytest.mark.slow
@pytest.mark.timeout(600)
@pytest.mark.usefixtures("patient_sessions")
def test_no_acknowledged_transaction_is_lost_by_kill_9_at_any_moment(
    repository: Path,
    tmp_path: Path,
    router_endpoint: str,
    free_port: Callable[[], int],
    monkeypatch: pytest.MonkeyPatch,
    record_property: Callable[[str, object], None],
):
    monkeypatch.setenv("TOPNAV_LOG_LEVEL", "ERROR")
    report = kill_often(tmp_path, repository, router_endpoint, free_port(), KILLS, seed=7, longest_s=0.4)
    for name, value in report.figures().items():
        record_property(name, value)
    assert report.wrong == []
    assert (report.lost, report.corrupt) == (0, 0)
    assert report.acknowledged > KILLS


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_a_changed_byte_is_noticed_wherever_something_is_kept(tmp_path: Path):
    found = list(flips(tmp_path, FLIPS, seed=3, mend=False))
    assert [flip for flip in found if flip.verdict == "undetected"] == []
    used = sum(flip.verdict == "detected" for flip in found)
    assert FLIPS // 4 <= used < FLIPS  # the rest are free pages and gaps in pages
