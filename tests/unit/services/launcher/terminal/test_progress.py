"""Progress where nobody looks at a terminal: a line now and then."""

import io

from rich.console import Console

from services.launcher.terminal import progress


def test_lines_come_no_oftener_than_every_period(monkeypatch):
    now_s = [0.0]
    monkeypatch.setattr(progress.time, "monotonic", lambda: now_s[0])
    said = []
    lines = progress.LinesNowAndThen(said.append)
    for at_s in (1.0, 19.0, 20.0, 21.0, 39.0, 41.0):
        now_s[0] = at_s
        lines(f"at {at_s:g}")
    assert said == ["at 20", "at 41"]


def test_stage_is_told_with_how_much_of_it_is_done(monkeypatch):
    monkeypatch.setattr(progress, "LINE_PERIOD_S", 0.0)
    file = io.StringIO()
    with progress.stage_progress(Console(file=file, width=200), "importing [x]") as told:
        told("models", 3, 40)
        told("free floor", 0, 1)
    assert file.getvalue().splitlines() == ["importing [x]: models 3/40", "importing [x]: free floor"]
