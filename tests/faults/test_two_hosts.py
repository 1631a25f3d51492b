"""Robot and services on two hosts, over mutual TLS, with delay, loss and cuts."""

import json
import shutil
import subprocess
import sys
from pathlib import Path
from statistics import median

import pytest

from tests.faults.two_hosts import NO_NETWORK

pytestmark = [pytest.mark.timeout(600)]

DELAY_S, LOSS, CUTS = 0.1, 0.02, 3
EXPLORE_S = 30.0
STOPS_S = 0.5 + DELAY_S


def test_the_wheels_stand_soon_after_a_cut_and_the_mission_completes_when_it_heals(tmp_path):
    if shutil.which("ip") is None or not Path("/dev/net/tun").exists():
        pytest.skip("a line between two hosts needs the program ip and /dev/net/tun")
    report = tmp_path / "report.json"
    line = [f"--delay-s={DELAY_S}", f"--loss={LOSS}", f"--cuts={CUTS}", f"--explore-s={EXPLORE_S}"]
    command = [sys.executable, "-m", "tests.faults.two_hosts", *line, f"--json={report}"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=580, check=False)
    if NO_NETWORK in done.stderr:
        pytest.skip(NO_NETWORK)
    assert done.returncode == 0, done.stderr + done.stdout
    found = json.loads(report.read_text(encoding="utf-8"))
    assert found["mission"] == "succeeded"
    assert found["collisions"] == 0
    assert 1 <= len(found["still_after_s"]) <= CUTS
    assert None not in found["still_after_s"]
    assert median(found["still_after_s"]) <= STOPS_S
