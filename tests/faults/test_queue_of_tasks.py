"""A queue of tasks and a schedule while every service in turn gets kill -9: all end, each once."""

import os
import signal
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress

import pytest

from services.launcher.processes.supervisor import Launcher
from shared.bus import Bus, open_bus
from shared.messages.missions import Event
from shared.messages.tasks import Errand, Schedule, Task
from shared.queries import QueryError
from shared.topics import EVENT, STATUS
from shared.wire import decode
from tests.integration.dispatch.conftest import MISSIONS, Queue
from tests.integration.dispatch.robot import Robot, until

SERVICES = ("map-store", "planner", "dispatch", "drive", "features", "gateway", "router")
TASKS, FRAMES = 21, 15
"""Three for each service that is killed, each of 1.5 s: a kill meets tasks that wait, run and end."""
MINUTE_S, PATIENCE_S = 60.0, 120.0


@pytest.fixture(scope="module")
def stack(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Launcher]:
    """All services but the robot."""
    folder = tmp_path_factory.mktemp("data")
    settings = {"PLANNER_MISSIONS_FOLDER": str(MISSIONS), "DISPATCH_PERIOD_S": "0.2"}
    with Launcher(folder, only=list(SERVICES), environment=settings, timeout_s=300.0) as launcher:
        yield launcher


@pytest.fixture
def bus(stack: Launcher) -> Iterator[Bus]:
    """A session of whoever asks, beside a robot that is none."""
    with open_bus(stack.endpoint) as opened, Robot(opened, drives=False):
        yield opened


@pytest.fixture
def counted(bus: Bus) -> list[tuple[str, str]]:
    """Every frame that a mission counted, as it is told: its mission and its number.

    A planner tells of a frame when it is on record, so one that dies in between counts it anew, untold.
    """
    heard: list[tuple[str, str]] = []

    def keep(_key: str, payload: bytes) -> None:
        event = decode(Event, payload, EVENT.max_bytes)
        if event.kind == "hold" and event.reason.startswith("counted"):
            heard.append((event.mission_id, event.reason))

    bus.tap(EVENT, keep)
    return heard


@pytest.fixture
def queue(bus: Bus) -> Queue:
    """The robot's queue, and a map for its tasks."""
    asked = Queue(bus)
    asked.add("map-maker", kind="make_map")
    asked.wait("map-maker", "succeeded")
    return asked


def read(queue: Queue):
    """The queue with all that ended; None while the map store is away."""
    try:
        return queue.ask("read", ended=200)
    except QueryError:
        return None


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_all_tasks_end_once_and_a_schedule_makes_one_for_each_time(
    stack: Launcher, queue: Queue, counted: list[tuple[str, str]]
):
    names = [f"t{number:02}" for number in range(TASKS)]
    count = {"kind": "count", "map": "flat", "parameters": {"frames": FRAMES}}
    scheduled = Errand(**count, priority=9)
    schedule = Schedule(name="minutes", robot="r1", cron="* * * * *", task=scheduled)
    queue.ask("put_schedule", schedule=schedule)
    set_s = time.time()
    for name in names:
        queue.ask("add", task=Task(task_id=name, robot="r1", **count))

    for service in SERVICES:
        old = stack.kill(service)
        stack.wait_healthy(service, PATIENCE_S, other_than=old)
        until(lambda: _one_more(queue), PATIENCE_S, f"after {service} was killed nothing goes on")

    until(lambda: _all_ended(queue), 3 * PATIENCE_S, "not all tasks ended")
    until(lambda: time.time() // MINUTE_S > set_s // MINUTE_S, 2 * MINUTE_S, "no minute passed")
    until(lambda: _made(queue), PATIENCE_S, "the schedule made nothing")
    queue.ask("remove_schedule", name="minutes")
    until(lambda: _all_ended(queue), PATIENCE_S, "not all tasks ended")
    ended = queue.ask("read", ended=200).ended

    assert {task.task_id: task.state for task in ended if task.task_id in names} == dict.fromkeys(
        names, "succeeded"
    )
    made = [task for task in ended if task.schedule]
    assert len({task.due_ns for task in made}) == len(made)
    assert {task.state for task in made} == {"succeeded"}
    assert {mission for mission, _ in counted} == {task.mission_id for task in ended if task.kind == "count"}
    again = {frame: times for frame, times in Counter(counted).items() if times > 1}
    assert not again, "no task was begun twice, and none did again what it had done"


@pytest.mark.slow
@pytest.mark.timeout(900)
def test_an_end_that_the_map_store_was_not_there_for_is_on_record_when_it_is_back(
    stack: Launcher, queue: Queue, bus: Bus
):
    statuses = bus.subscribe(STATUS, robot="r1")
    queue.add("unheard", frames=FRAMES, keeps=False)
    queue.wait("unheard", "running")
    frozen = stack.pid("map-store")
    assert frozen is not None
    os.kill(frozen, signal.SIGSTOP)
    try:
        until(
            lambda: any(s.mission_id == "unheard" and s.state == "succeeded" for s in statuses.take_all()),
            PATIENCE_S,
            "it does not end",
        )
    finally:
        with suppress(ProcessLookupError):  # the launcher may have ended it
            os.kill(frozen, signal.SIGCONT)
    until(lambda: _all_ended(queue), PATIENCE_S, "the end is not on record")
    assert queue.task("unheard").state == "succeeded"


def _all_ended(queue: Queue) -> bool:
    """Whether nothing runs or waits."""
    now = read(queue)
    return now is not None and not now.tasks


def _made(queue: Queue) -> bool:
    """Whether the schedule has made a task."""
    now = read(queue)
    return now is not None and any(task.schedule for task in (*now.tasks, *now.ended))


def _one_more(queue: Queue) -> bool:
    """Whether a task runs, or none is left."""
    now = read(queue)
    return now is not None and (not now.tasks or now.tasks[0].state == "running")
