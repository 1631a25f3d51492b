"""A service that ends again and again: ever longer pauses, and everybody who asks is told that it is down."""

import json
import subprocess
import sys
import time
from itertools import chain, repeat

import httpx
import pytest

from services.launcher.processes.runner import State
from services.launcher.processes.supervisor import Launcher
from shared.bus import wait_until

STORM_S = 150.0
PAUSES_S = (0.3, 0.6, 1.2, 2.4, 4.8, 9.6)
LATER_S = 4.8
"""Only exits of the last minute count: where each start takes long, pauses get somewhat shorter again."""


def most_restarts(elapsed_s):
    """How often a process may have ended by then, if each pause is as long as it must be."""
    ends = 1
    for pause_s in chain(PAUSES_S, repeat(LATER_S)):
        elapsed_s -= pause_s
        if elapsed_s < 0.0:
            return ends
        ends += 1


@pytest.mark.slow
@pytest.mark.timeout(600)
def test_a_crash_loop_backs_off_and_shows_as_degraded_in_the_shell_and_as_missing_over_http(
    tmp_path, repository
):
    broken = {"PLANNER_NO_SUCH_SETTING": "1"}  # it ends as soon as it reads its settings
    stack = Launcher(tmp_path, only=["planner", "gateway", "map-store"], environment=broken)
    began_s = time.monotonic()
    stack.start(wait=False)
    try:
        assert wait_until(lambda: stack.status()["planner"].state is State.DEGRADED, STORM_S)
        stack.wait_healthy("gateway", STORM_S)
        command = [sys.executable, "-m", "services.launcher", "status", "--json", "--data-dir", str(tmp_path)]
        shown = subprocess.run(command, cwd=repository, capture_output=True, text=True, check=False)
        assert shown.returncode == 1
        told = json.loads(shown.stdout)["services"]
        assert told["planner"]["state"] == "degraded"
        assert told["gateway"]["state"] == "healthy"
        ready = httpx.get(f"{stack.gateway_url}/readyz", timeout=30.0, trust_env=False)
        assert ready.status_code == 503
        assert "planner" in ready.json()["missing"]
        assert wait_until(lambda: stack.status()["planner"].restarts >= len(PAUSES_S) + 1, STORM_S)
        restarts = stack.status()["planner"].restarts
        assert restarts <= most_restarts(time.monotonic() - began_s), "it must pause longer each time"
    finally:
        stack.stop()
