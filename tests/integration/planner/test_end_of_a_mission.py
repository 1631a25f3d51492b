"""A planner killed when a mission had just ended: the next one says how it ended, not that there was none."""

import os
import subprocess
import sys
from pathlib import Path

import httpx
import pytest

from shared.bus import Bus, wait_until
from shared.messages.missions import MissionRequest, MissionStatus
from shared.topics import MISSION, STATUS
from tests.integration.map_store.conftest import START_S
from tests.integration.map_store.conftest import bus as bus
from tests.integration.map_store.conftest import process as process

ANSWER_S = 60.0

pytestmark = pytest.mark.usefixtures("patient_sessions")


@pytest.fixture
def planner(bus: Bus, router_endpoint: str, repository: Path):
    """Starts a planner and waits for it; the one before is killed."""
    running: list[subprocess.Popen[bytes]] = []

    def kill() -> None:
        for one in running:
            one.kill()
            one.wait()
        running.clear()

    def start() -> None:
        kill()
        assert wait_until(lambda: "planner" not in bus.alive(), START_S)
        environment = os.environ | {"TOPNAV_ENDPOINT": router_endpoint}
        command = [sys.executable, "-m", "tests.patient", "services.planner"]
        running.append(subprocess.Popen(command, cwd=repository, env=environment))
        assert wait_until(lambda: "planner" in bus.alive(), START_S)

    yield start
    kill()


def ask(bus: Bus, **request) -> MissionStatus:
    return bus.ask(MISSION, MissionRequest(**request), ANSWER_S, robot="r1")


def end(bus: Bus) -> None:
    ask(bus, action="explore", map="flat", mission_id="m-1", seed=3)
    assert ask(bus, action="cancel").state == "cancelled"


def test_the_end_of_a_mission_outlives_the_planner_and_is_told_unasked(bus: Bus, planner):
    planner()
    end(bus)
    statuses = bus.subscribe(STATUS, robot="r1")
    planner()
    told: list[MissionStatus] = []
    assert wait_until(lambda: told.extend(s for s in statuses.take_all() if s.epoch == 2) or told, START_S)
    for status in (told[0], ask(bus, action="status")):
        assert (status.mission_id, status.action, status.map) == ("m-1", "explore", "flat")
        assert (status.state, status.failure, status.reason) == (
            "cancelled",
            "cancelled",
            "cancelled by request",
        )


def test_after_it_another_mission_starts_also_where_the_map_is_gone(bus: Bus, planner, process):
    planner()
    end(bus)
    httpx.delete(f"{process.url}/maps/flat", trust_env=False, timeout=ANSWER_S).raise_for_status()
    planner()
    assert ask(bus, action="status").state == "cancelled"
    assert ask(bus, action="explore", map="loft", mission_id="m-2").state == "running"
    planner()
    status = ask(bus, action="status")
    assert (status.mission_id, status.state, status.failure) == ("m-2", "running", "")
