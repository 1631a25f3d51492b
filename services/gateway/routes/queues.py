"""Questions about the queue of a robot, and what pages are told of tasks and schedules."""

from datetime import UTC, datetime
from typing import Any

from pydantic import BaseModel

from services.gateway.routes.robots import known
from services.gateway.state import Gateway
from shared.messages.missions import MissionKindsRequest
from shared.messages.tasks import Errand, Schedule, Task, TaskReply, TaskRequest
from shared.schedules.due_times import DueTimes, ScheduleError
from shared.topics import MISSION_KINDS, TASKS
from shared.transport.keys import ANY
from shared.web.problems import ProblemError


class TaskAnswer(BaseModel):
    """A task and the mission that carries it out; times are null until they come."""

    task_id: str
    mission_id: str
    robot: str
    kind: str
    map: str
    parameters: dict[str, Any]
    priority: int
    seed: int
    max_steps: int
    state: str
    failure: str
    reason: str
    for_battery: bool
    schedule: str
    by: str
    fleet: bool
    due: datetime | None
    created: datetime | None
    started: datetime | None
    ended: datetime | None

    @classmethod
    def of(cls, task: Task) -> "TaskAnswer":
        """The task for pages."""
        times = {
            name: time_of(getattr(task, f"{name}_ns")) for name in ("due", "created", "started", "ended")
        }
        return cls.model_validate({**task.model_dump(), **times, "mission_id": task.mission_id})


class ScheduleAnswer(BaseModel):
    """A schedule; `next` is when it makes its next task, null for never."""

    name: str
    robot: str
    cron: str
    time_zone: str
    task: Errand
    enabled: bool
    next: datetime | None
    skipped: int
    last_skipped: datetime | None

    @classmethod
    def of(cls, schedule: Schedule, now_ns: int) -> "ScheduleAnswer":
        """The schedule for pages."""
        last = time_of(schedule.skipped_ns)
        times = {"next": _next(schedule, now_ns), "last_skipped": last}
        return cls.model_validate({**schedule.model_dump(), **times})


def time_of(moment_ns: int) -> datetime | None:
    """A moment for pages; None for 0, which stands for never."""
    return datetime.fromtimestamp(moment_ns / 1e9, UTC) if moment_ns else None


async def ask_queue(gateway: Gateway, robot: str, request: TaskRequest) -> TaskReply:
    """Ask the map store.

    Raises:
        ProblemError: 404 nobody heard of the robot, or no such task or schedule; else as `Asker.ask`.
    """
    if robot not in (gateway.settings.robot, ANY):
        known(gateway, robot)
    timeout_s = gateway.settings.ask_timeout_s
    try:
        return await gateway.asker.ask("map_store", TASKS, request, timeout_s, queue=robot)
    except ProblemError as problem:
        if problem.members.get("reason") == "missing":
            got, next_step = str(problem.members["got"]), f"see /api/robots/{robot}/tasks and .../schedules"
            raise ProblemError(
                404, "no_such_task", "a task or schedule that is there", got, next_step
            ) from None
        raise


async def check_errand(gateway: Gateway, robot: str, errand: Errand) -> None:
    """Refuse what the robot's planner does not know; while it is away, it does so when the task begins.

    For the whole fleet that of this gateway's own robot speaks.

    Raises:
        ProblemError: 422 unknown kind, or parameters that the kind does not have or lacks.
    """
    timeout_s = gateway.settings.ask_timeout_s
    robot = gateway.settings.robot if robot == ANY else robot
    try:
        reply = await gateway.asker_for(robot).ask(
            "planner", MISSION_KINDS, MissionKindsRequest(), timeout_s, robot=robot
        )
    except ProblemError as problem:
        if problem.status_code in (503, 504):
            return
        raise
    kinds = {kind.name: kind.parameters for kind in reply.kinds}
    see = f"see /api/robots/{robot}/mission-kinds"
    if errand.kind not in kinds:
        raise ProblemError(422, "unknown_kind", f"one of {', '.join(sorted(kinds))}", errand.kind, see)
    schema = kinds[errand.kind]
    properties, required = schema.get("properties"), schema.get("required")
    names = set(properties) if isinstance(properties, dict) else set()
    if unknown := sorted(errand.parameters.keys() - names):
        expected = f"parameters of {errand.kind}: {', '.join(sorted(names)) or 'none'}"
        raise ProblemError(422, "unknown_parameter", expected, ", ".join(unknown)[:200], see)
    if isinstance(required, list) and (lacking := [n for n in required if n not in errand.parameters]):
        expected = f"the parameters that {errand.kind} needs: {', '.join(map(str, required))}"
        raise ProblemError(422, "missing_parameter", expected, f"none of {lacking}", see)


def _next(schedule: Schedule, now_ns: int) -> datetime | None:
    if not schedule.enabled:
        return None
    try:
        due_ns = DueTimes(schedule.cron, schedule.time_zone).next(now_ns)
    except ScheduleError:  # written by a program that reads cron otherwise
        return None
    return None if due_ns is None else time_of(due_ns)
