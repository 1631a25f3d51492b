"""The queue of a robot, as the commands about tasks and schedules need it: of a stack that runs."""

import time
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

from services.launcher.client.address import running_address
from services.launcher.client.failure import ExperimentError, one_line_errors
from shared.bus import Bus
from shared.messages.missions import MissionKindsRequest, MissionRequest
from shared.messages.tasks import Errand, Schedule, Task, TaskReply, TaskRequest
from shared.queries import AbsentError
from shared.schedules.due_times import DueTimes, ScheduleError
from shared.topics import MISSION, MISSION_KINDS, TASKS
from shared.transport.keys import ANY

TIMEOUT_S = 10.0
"""Reading or writing a few records; chosen."""


class QueueClient:
    """Asks for one robot's tasks and schedules over the bus."""

    def __init__(self, bus: Bus, robot: str) -> None:
        self._bus, self._robot = bus, robot

    def ask(self, request: TaskRequest) -> TaskReply:
        """Ask the map store."""
        return self._bus.ask(TASKS, request, TIMEOUT_S, queue=self._robot)

    def check(self, errand: Errand) -> None:
        """Refuse a kind that the planner does not know, where one is there to say so.

        Raises:
            ExperimentError: it does not; the text names those that it knows.
        """
        if self._robot == ANY:  # whose planner would know? the one that gets it says so
            return
        try:
            kinds = self._bus.ask(MISSION_KINDS, MissionKindsRequest(), TIMEOUT_S, robot=self._robot).kinds
        except AbsentError:  # it says so when the task is to begin
            return
        names = [kind.name for kind in kinds]
        if errand.kind not in names:
            raise ExperimentError(f"unknown kind {errand.kind!r}: one of {', '.join(names)}")

    def cancel(self, task_id: str) -> Task:
        """Cancel a task, with its mission where it runs; returns it as it stood before that."""
        task = self.ask(TaskRequest(action="cancel", task_id=task_id)).task
        assert task is not None
        if task.state == "running":
            wish = MissionRequest(action="cancel", map=task.map, mission_id=task.mission_id)
            self._bus.ask(MISSION, wish, TIMEOUT_S, robot=task.robot)
        return task


@contextmanager
def open_queue(robot: str, data_dir: Path, endpoint: str | None) -> Iterator[QueueClient]:
    """The queue of `robot`, or of ANY, in the stack at `endpoint`, or the one that runs in `data_dir`.

    Raises:
        ExperimentError: no stack runs there, or what its services report.
    """
    address = running_address(endpoint, data_dir)
    with one_line_errors(), address.open() as bus:
        yield QueueClient(bus, robot)


def next_due(schedule: Schedule) -> str:
    """When a schedule makes its next task, by the clocks of this machine.

    Raises:
        ExperimentError: it is no schedule; the text says what is wrong with it.
    """
    try:
        due_ns = DueTimes(schedule.cron, schedule.time_zone).next(time.time_ns())
    except ScheduleError as error:
        raise ExperimentError(str(error)) from None
    return "off" if not schedule.enabled else "never" if due_ns is None else clock(due_ns)


def clock(moment_ns: int) -> str:
    """A moment by the clocks of this machine; "" for 0, which stands for never."""
    if not moment_ns:
        return ""
    return datetime.fromtimestamp(moment_ns / 1e9).astimezone().isoformat(sep=" ", timespec="seconds")
