"""Dispatch loop: looks at queue and robot, does the one thing that follows, and says where it stands."""

import logging
import threading
import time

from services.dispatch.core import Step, next_step
from services.dispatch.settings import DispatchSettings
from shared.bus import Bus
from shared.messages.missions import MissionRequest, MissionStatus
from shared.messages.tasks import QueueStatus, Schedule, Task, TaskReply, TaskRequest
from shared.queries import QueryError, RefusedError
from shared.robots.hearing import Hearing
from shared.robots.seen import Seen
from shared.schedules.due_times import NS, DueTimes, ScheduleError
from shared.topics import MISSION, QUEUE, TASKS
from shared.wire import WireError

log = logging.getLogger(__name__)

FINAL = frozenset({"invalid", "missing", "forbidden", "corrupt"})
"""Refusals of a planner that stay: asked again, it would say the same."""


class Dispatch:
    """Begins the tasks of one robot, one after the other. Holds nothing that a restart would need."""

    def __init__(self, settings: DispatchSettings, bus: Bus) -> None:
        self._settings, self._bus = settings, bus
        self._limits = settings.limits()
        self._hearing = Hearing(bus, settings.robot)
        self._statuses = bus.publisher(QUEUE, robot=settings.robot)
        self._count = 0
        self._alarm = ""

    def step(self, now_s: float, now_ns: int) -> None:
        """Do what there is to do; `now_s` is monotonic, `now_ns` the wall clock.

        Raises:
            QueryError, WireError: the map store or the planner does not answer as it should.
        """
        seen = self._hearing.listen(now_s)
        queue = self._ask(TaskRequest(action="read"))
        for schedule in queue.schedules:
            queue = self._make_due(schedule, queue, now_ns)
        step = next_step(queue, seen, self._limits)
        self._tell(queue, step)
        self._act(step, seen)

    def _act(self, step: Step, seen: Seen) -> None:
        task = step.task
        if task is None:
            return
        if step.action == "begin":
            self._begin(task)
        elif step.action == "go_home":
            log.warning("%s: going home, then on hold", step.why)
            self._ask(TaskRequest(action="go_home", task=task))
        elif step.action in ("resume", "cancel"):
            assert seen.status is not None
            log.info("%s mission %s", step.action, task.mission_id)
            self._mission(MissionRequest(action=step.action, map=task.map, mission_id=task.mission_id))

    def _begin(self, task: Task) -> None:
        """Ask the planner for the mission. Only a refusal that stays ends the task; else it waits."""
        wish = MissionRequest(
            action=task.kind,
            map=task.map,
            mission_id=task.mission_id,
            parameters=task.parameters,
            checkpoint=task.checkpoint,
            seed=task.seed,
            max_steps=task.max_steps,
        )
        try:
            self._mission(wish)
        except RefusedError as error:
            if error.code not in FINAL:
                raise
            log.warning("task %s failed, the planner refuses it: %s", task.task_id, error)
            reason = str(error)[:400]
            self._ask(TaskRequest(action="refuse", task_id=task.task_id, reason=reason))
        else:
            log.info("task %s began: %s in %s", task.task_id, task.kind, task.map)

    def _make_due(self, schedule: Schedule, queue: TaskReply, now_ns: int) -> TaskReply:
        """Have a schedule make its task where it is due; returns the queue afterwards."""
        if not schedule.enabled:
            return queue
        times, within_ns = DueTimes(schedule.cron, schedule.time_zone), round(self._settings.catch_up_s * NS)
        try:
            due = times.due(schedule.handled_ns, now_ns, within_ns)
        except ScheduleError as error:
            self._bus.counters.count("schedule", f"{schedule.name}: {error}")
            return queue
        about = {"action": "make_due", "name": schedule.name}
        if due.missed:  # up to the one that still counts
            handled_ns = now_ns if due.at_ns is None else due.at_ns - 1
            why = f"a time was missed that is more than {self._settings.catch_up_s:g} s or one time ago"
            skipped = TaskRequest.model_validate({**about, "due_ns": handled_ns, "skip": True, "reason": why})
            queue = self._ask(skipped)
        if due.at_ns is not None:
            queue = self._ask(TaskRequest.model_validate({**about, "due_ns": due.at_ns}))
        return queue

    def _tell(self, queue: TaskReply, step: Step) -> None:
        if step.alarm != self._alarm:
            self._alarm = step.alarm
            if step.alarm:
                log.error("alarm: %s", step.alarm)
        running = next((task.task_id for task in queue.tasks if task.state == "running"), "")
        self._count += 1
        self._statuses.put(
            QueueStatus(
                seq=self._count,
                robot=self._settings.robot,
                waiting=sum(task.state == "queued" for task in queue.tasks),
                running=running,
                why=step.why[:200],
                on_hold=step.on_hold,
                alarm=step.alarm,
            )
        )

    def _ask(self, request: TaskRequest) -> TaskReply:
        return self._bus.ask(TASKS, request, self._settings.query_timeout_s, queue=self._settings.robot)

    def _mission(self, request: MissionRequest) -> MissionStatus:
        return self._bus.ask(MISSION, request, self._settings.query_timeout_s, robot=self._settings.robot)


def run(settings: DispatchSettings, bus: Bus, stop: threading.Event) -> None:
    """Look at the queue once a period until `stop`; who is away is waited for."""
    dispatch = Dispatch(settings, bus)
    bus.announce("dispatch")
    while not stop.wait(settings.period_s):
        try:
            dispatch.step(time.monotonic(), time.time_ns())
        except (QueryError, WireError) as error:
            bus.counters.count("unanswered", str(error))
