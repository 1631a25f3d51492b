"""The bench of the loop measures every stage that its figures promise. Never gates on how fast it was."""

import json
import subprocess
import sys

import pytest

pytestmark = [pytest.mark.render, pytest.mark.slow, pytest.mark.timeout(600)]


def test_bench_loop_reports_rate_stages_and_machine(repository, tmp_path):
    figures = tmp_path / "bench.json"
    command = [
        sys.executable,
        "-m",
        "services.launcher",
        "bench",
        "loop",
        "--steps",
        "30",
        "--json",
        str(figures),
    ]
    answer = subprocess.run(command, cwd=repository, capture_output=True, text=True, timeout=500)
    assert answer.returncode == 0, answer.stderr
    report = json.loads(figures.read_text())
    assert report["steps_per_s"] > 0.0
    promised = {"render", "transport", "extract", "match", "verify", "plan", "drive"}
    assert promised <= report["stages"].keys()
    assert all(row["p99_ms"] >= row["p50_ms"] >= 0.0 for row in report["stages"].values())
    assert {"processor", "cpus", "memory_gb"} <= report["machine"].keys()
