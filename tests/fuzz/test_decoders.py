"""Every decoder under a short, seeded fuzz: it accepts or refuses with its own error, within its limits."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from tests.fuzz.catalogue import FAMILIES

ROOT = Path(__file__).resolve().parents[2]
EXECUTIONS = {
    "bus": 500,
    "pictures": 800,
    "archives": 800,
    "recordings": 800,
    "worlds": 250,
    "importing": 400,
    "files": 500,
    "requests": 400,
}
TAKES_ANYTHING = {"files/estop", "files/missions", "files/run"}
"""Readers without an error of their own: what they cannot read they count, or stop the robot."""


@pytest.mark.timeout(900)
@pytest.mark.parametrize("name", FAMILIES)
def test_no_decoder_crashes_hangs_or_takes_much_memory(name: str, tmp_path: Path) -> None:
    command = [sys.executable, "-m", "tests.fuzz.worker", name, f"--executions={EXECUTIONS[name]}"]
    run = subprocess.run(
        [*command, "--seed=1", f"--keep={tmp_path}"], cwd=ROOT, capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr[-2000:]
    tallies = [json.loads(line) for line in run.stdout.splitlines() if line.startswith("{")]
    assert tallies
    for tally in tallies:
        assert not tally["crashes"], kept(tmp_path / tally["decoder"])
        assert tally["executions"] >= EXECUTIONS[name]
        assert tally["counts"]["accepted"] > 0, f"{tally['decoder']}: not even its seeds are accepted"
        if tally["decoder"] not in TAKES_ANYTHING:
            assert tally["counts"]["refused"] > 0
            assert tally["ways"] > 1


def kept(folder: Path) -> str:
    """Why the inputs in `folder` are kept."""
    return "\n".join(path.read_text(encoding="utf-8")[-1500:] for path in sorted(folder.glob("*.txt")))
