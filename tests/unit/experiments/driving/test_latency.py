"""The latency study: which delays it takes, what it writes, and going on with a file."""

import json

import pytest

from experiments.commands import latency
from experiments.driving import latency as driven
from services.launcher.client.failure import ExperimentError
from simulator.disturbances.levels import Disturbances

FIXED = [
    "latency_ms", "rate_hz", "success_rate", "spl_mean", "final_distance_median_m", "collisions",
]  # fmt: skip


def figures(success):
    return {
        "success": success, "spl": 0.8, "failure": "", "final_distance_m": 0.1, "collisions": 0,
        "manual_moves": 0, "steps": 50, "wall_s": 5.0, "path_ratio": 1.2, "edges_suspended": 0,
        "driven_m": 3.0,
    }  # fmt: skip


@pytest.fixture
def played(monkeypatch):
    """Rounds that nobody plays: what the stacks would have been started with."""
    asked = []

    def play(_study, _label, levels, environment):
        asked.append((levels, environment))
        return [figures(True), figures(False)]

    monkeypatch.setattr(driven, "play", play)
    return asked


def test_a_point_has_the_fixed_keys_and_the_speed_of_the_simulated_time(played):
    point = driven.run_point(None, 300, 5.0)
    assert list(point)[:6] == FIXED
    assert point["speed_mean_mps"] == pytest.approx(6.0 / (100 / 5.0))
    assert played == [(Disturbances(latency=0.5), {"SIMULATOR_CONTROL_PERIOD_S": "0.2"})]


def test_a_study_goes_on_where_it_stopped_and_draws_all_points(played, tmp_path):
    file, plot = tmp_path / "f.json", tmp_path / "f.png"
    options = {"rounds": 2, "data_dir": tmp_path, "json_file": file, "plot": plot}
    latency.latency(latencies="300", **options)
    latency.latency(latencies="0,300,600", **options)
    points = json.loads(file.read_text())["points"]
    assert [point["latency_ms"] for point in points] == [300, 0, 600]
    assert len(played) == 3
    assert plot.stat().st_size > 1000


@pytest.mark.parametrize(("text", "says"), [("a", "whole milliseconds"), ("700", "from 0 to 600 ms")])
def test_wrong_delays_are_refused(text, says, tmp_path):
    with pytest.raises(ExperimentError, match=says):
        latency.latency(latencies=text, data_dir=tmp_path)
