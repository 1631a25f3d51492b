"""The bench of the loop measures every stage that its figures promise. Never gates on how fast it was."""

import json
import subprocess
import sys

import pytest

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]


@pytest.mark.parametrize("real_time", [False, True], ids=["lockstep", "real time"])
def test_bench_loop_reports_rate_stages_and_machine(repository, tmp_path, real_time):
    figures = tmp_path / "bench.json"
    command = [
        sys.executable,
        "-m",
        "services.launcher",
        "bench",
        "loop",
        "--steps",
        "20",
        "--json",
        str(figures),
        *(["--real-time"] if real_time else []),
    ]
    answer = subprocess.run(command, cwd=repository, capture_output=True, text=True, timeout=500)
    assert answer.returncode == 0, answer.stderr
    report = json.loads(figures.read_text())
    assert report["steps_per_s"] > 0.0
    promised = {"render", "transport", "extract", "match", "verify", "plan", "drive"}
    assert real_time or promised <= report["stages"].keys()
    waits = report["frame_to_command"]
    assert report["lockstep"] is not real_time
    assert 0.0 < waits["p50_ms"] <= waits["p99_ms"]
    assert 0.0 < waits["answered"] <= 1.0
    assert all(row["p99_ms"] >= row["p50_ms"] >= 0.0 for row in report["stages"].values())
    assert {"planner", "drive", "features", "map-store", "gateway"} <= report["cpu"].keys()
    assert all(report["cpu"][name]["ms_per_step"] > 0.0 for name in ("planner", "drive", "features"))
    assert {"processor", "cpus", "memory_gb"} <= report["machine"].keys()
