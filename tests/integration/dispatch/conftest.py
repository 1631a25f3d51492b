"""Map store, planner and dispatch as processes, with a robot that is none; a module shares them."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest
import zenoh

from services.launcher.processes.free_ports import free_ports
from shared.bus import Bus, open_bus, wait_until
from shared.messages.missions import MissionRequest
from shared.messages.tasks import Task, TaskReply, TaskRequest
from shared.queries import QueryError
from shared.topics import MISSION, TASKS
from shared.transport.router_config import router_config
from tests.integration.dispatch.robot import Robot, until
from tests.integration.map_store.conftest import START_S

MISSIONS = Path(__file__).parent / "missions"
ANSWER_S, GONE_S = 60.0, 1.0


class Queue:
    """The robot's queue, asked over the bus."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus

    def ask(self, action: str, **fields: object) -> TaskReply:
        request = TaskRequest.model_validate({"action": action, **fields})
        return self._bus.ask(TASKS, request, ANSWER_S, queue="r1")

    def add(self, task_id: str, kind: str = "count", **parameters: object) -> None:
        task = Task(task_id=task_id, robot="r1", kind=kind, map="flat", parameters=parameters)
        self.ask("add", task=task)

    def task(self, task_id: str) -> Task:
        found = self.ask("read", task_id=task_id).task
        assert found is not None
        return found

    def end(self, task: Task) -> None:
        """Cancel a task, with its mission where it runs."""
        with suppress(QueryError):  # it has just ended, or the planner of the last test is gone
            if self.ask("cancel", task_id=task.task_id).task.state == "running":
                wish = MissionRequest(action="cancel", mission_id=task.mission_id)
                self._bus.ask(MISSION, wish, GONE_S, robot="r1")

    def wait(self, task_id: str, *states: str) -> Task:
        """Wait until a task is in one of these states."""
        until(lambda: self.task(task_id).state in states, ANSWER_S, f"{task_id} is not {states}")
        return self.task(task_id)


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    """A router."""
    address = f"tcp/127.0.0.1:{free_ports(1)[0]}"
    with zenoh.open(router_config(address)):
        yield address


@pytest.fixture(scope="module")
def bus(endpoint: str, patient_sessions: None) -> Iterator[Bus]:  # noqa: ARG001
    """A session of whoever asks."""
    with open_bus(endpoint) as opened:
        yield opened


@pytest.fixture(scope="module")
def planner(
    bus: Bus, endpoint: str, repository: Path, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[subprocess.Popen[bytes]]:
    """A planner that knows the missions of this folder, its map store, and a dispatch that looks often."""
    environment = os.environ | {
        "TOPNAV_ENDPOINT": endpoint,
        "MAP_STORE_PORT": str(free_ports(1)[0]),
        "MAP_STORE_DATABASE_URL": f"sqlite:///{tmp_path_factory.mktemp('maps')}/maps.sqlite3",
        "PLANNER_MISSIONS_FOLDER": str(MISSIONS),
        "DISPATCH_PERIOD_S": "0.1",
    }
    running = {
        name: subprocess.Popen(
            [sys.executable, "-m", "tests.patient", f"services.{name}"], cwd=repository, env=environment
        )
        for name in ("map_store", "planner", "dispatch")
    }
    try:
        assert wait_until(lambda: running.keys() <= set(bus.alive()), START_S)
        yield running["planner"]
    finally:
        for one in running.values():
            one.kill()
            one.wait()


@pytest.fixture(scope="module")
def robot(bus: Bus, planner: object) -> Iterator[Robot]:
    """A robot whose services run and that has a map."""
    assert planner
    with Robot(bus) as one:
        queue = Queue(bus)
        queue.add("map-maker", kind="make_map")
        queue.wait("map-maker", "succeeded")
        yield one


@pytest.fixture
def queue(bus: Bus, robot: Robot) -> Iterator[Queue]:
    """Its queue, empty again afterwards."""
    asked = Queue(bus)
    yield asked
    robot.stop(False)
    for task in asked.ask("read").tasks:
        asked.end(task)
