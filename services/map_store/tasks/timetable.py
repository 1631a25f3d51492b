"""Schedules: one due time makes one task at most, whoever asks for it and however often."""

import logging

from sqlalchemy import Connection

from services.map_store.errors import ConflictError, MissingError
from services.map_store.tasks.records import (
    find_task,
    remove_schedule,
    schedules_of,
    tasks_in,
    write_schedule,
    write_task,
)
from shared.messages.tasks import Errand, Schedule, Task, TaskRequest

log = logging.getLogger(__name__)

MOST = 50
"""Schedules of one robot; chosen."""


def put_schedule(connection: Connection, wanted: Schedule, now_ns: int) -> None:
    """Keep a schedule. Only one that was on at the same times before remembers what it has made."""
    known = {schedule.name: schedule for schedule in schedules_of(connection, wanted.robot)[0]}
    before = known.get(wanted.name)
    if before is None and len(known) >= MOST:
        raise ConflictError(f"{wanted.robot} has {MOST} schedules, and no more may be: remove one")
    times = ("cron", "time_zone", "enabled")
    same = before is not None and all(getattr(before, name) == getattr(wanted, name) for name in times)
    history = {"handled_ns": now_ns, "skipped_ns": 0, "skipped": 0}
    if before is not None and same:
        history = {name: getattr(before, name) for name in history}
    write_schedule(connection, wanted.model_copy(update=history))


def take_schedule(connection: Connection, robot: str, name: str) -> None:
    """Remove a schedule; tasks that it made stay."""
    _schedule(connection, robot, name)
    remove_schedule(connection, robot, name)


def make_due(connection: Connection, robot: str, request: TaskRequest, now_ns: int) -> Task | None:
    """Make the task that a schedule wants at `request.due_ns`, or skip that time.

    Skipped is a time that the asker says to skip, and one at which the task of an earlier time still waits.

    Returns:
        The task; None where none was made, also because that time was handled before.
    """
    schedule, due_ns = _schedule(connection, robot, request.name), request.due_ns
    if not schedule.enabled or due_ns <= schedule.handled_ns:
        return None
    waits = any(task.schedule == schedule.name for task in tasks_in(connection, robot, ["queued"])[0])
    if request.skip or waits:
        log.warning(
            "robot %s: schedule %s makes no task this time: %s",
            robot,
            schedule.name,
            request.reason or "its task of an earlier time still waits",
        )
        skipped = {"handled_ns": due_ns, "skipped_ns": now_ns, "skipped": schedule.skipped + 1}
        write_schedule(connection, schedule.model_copy(update=skipped))
        return None
    write_schedule(connection, schedule.model_copy(update={"handled_ns": due_ns}))
    task_id = f"{schedule.name}-{due_ns // 1_000_000_000}"
    if find_task(connection, robot, task_id) is not None:  # of a schedule that was removed and made again
        return None
    task = Task(
        **{name: getattr(schedule.task, name) for name in Errand.model_fields},
        task_id=task_id,
        robot=robot,
        schedule=schedule.name,
        due_ns=due_ns,
        created_ns=now_ns,
    )
    write_task(connection, task)
    return task


def _schedule(connection: Connection, robot: str, name: str) -> Schedule:
    for schedule in schedules_of(connection, robot)[0]:
        if schedule.name == name:
            return schedule
    raise MissingError(f"{robot} has no schedule {name!r}")
