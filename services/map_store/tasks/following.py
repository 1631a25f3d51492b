"""Tasks follow the records of missions: what a planner saves moves the task of that id, in one transaction.

That is why a task is begun once at most, and ends once, whoever of those involved dies when: that a mission
began, and how it ended, is on record together with what that means for its task, or neither is.
"""

import logging

from sqlalchemy import Connection, delete, select

from services.map_store.errors import ConflictError
from services.map_store.storage.tables import tasks
from services.map_store.tasks.fleet import of_another
from services.map_store.tasks.records import find_task, tasks_in, write_task
from shared.messages.maps import MissionRecord
from shared.messages.missions import Parameters
from shared.messages.tasks import Task, TaskState, task_id_of

log = logging.getLogger(__name__)

ENDED: tuple[TaskState, ...] = ("succeeded", "failed", "cancelled")
KEPT = 200
"""Tasks of a robot that ended: a history of some days; chosen."""
LOST = "the record of its mission is gone: nobody knows how far it got"


def follow(connection: Connection, before: MissionRecord, record: MissionRecord, now_ns: int) -> None:
    """Have the robot's tasks say what `record` says of its mission; `before` is the record so far.

    Raises:
        ConflictError: the mission is that of a task that is over, or that another robot has by now.
    """
    task = find_task(connection, record.robot, task_id_of(record.mission_id))
    if task is None and record.action:
        _refuse_lost(connection, record)
    elif task is not None and record.action:
        _begin(connection, task, record.mission_id, now_ns)
    elif task is not None and task.state not in ENDED and task.mission_id == record.mission_id:
        same = before.mission_id == record.mission_id
        _end(connection, task, record, before.checkpoint if same else {}, now_ns)
    give_up_lost(connection, record, now_ns)


def give_up_lost(connection: Connection, record: MissionRecord, now_ns: int) -> None:
    """End tasks that are said to run and are not the mission on record, as when that was damaged."""
    for task in tasks_in(connection, record.robot, ["running"])[0]:
        if task.mission_id == record.mission_id:
            continue
        if task.put_back:
            _wait_again(connection, task, {})
        else:
            log.error("robot %s: task %s failed, %s", record.robot, task.task_id, LOST)
            finish(connection, task, "failed", "service_lost", LOST, now_ns)


def finish(
    connection: Connection, task: Task, state: TaskState, failure: str, reason: str, now_ns: int
) -> Task:
    """End a task, and forget the oldest of those that ended."""
    how = {"state": state, "failure": failure, "reason": reason[:400], "put_back": False}
    ended = task.model_copy(update={**how, "ended_ns": now_ns, "checkpoint": {}})
    write_task(connection, ended)
    over = tasks.c.robot == task.robot, tasks.c.state.in_(ENDED)
    order = tasks.c.ended_ns.desc(), tasks.c.task_id
    old = connection.execute(select(tasks.c.task_id).where(*over).order_by(*order).offset(KEPT))
    for task_id in old.scalars().all():
        connection.execute(delete(tasks).where(tasks.c.robot == task.robot, tasks.c.task_id == task_id))
    return ended


def _refuse_lost(connection: Connection, record: MissionRecord) -> None:
    """A robot from which a task of the fleet was taken may have been about to begin it."""
    task_id = task_id_of(record.mission_id)
    if (task := of_another(connection, record.robot, task_id)) is not None:
        raise ConflictError(f"task {task_id!r} is not with {record.robot} any more: {task.robot} has it")


def _begin(connection: Connection, task: Task, mission_id: str, now_ns: int) -> None:
    """A mission began, or goes on."""
    if task.mission_id != mission_id:
        raise ConflictError(f"mission {mission_id!r} is over: task {task.task_id!r} is {task.state} again")
    if task.state in ENDED:
        raise ConflictError(f"task {task.task_id!r} is over ({task.state}): it is not begun again")
    if task.state == "queued":
        begun = {"state": "running", "started_ns": now_ns, "put_back": False}
        write_task(connection, task.model_copy(update=begun))


def _end(
    connection: Connection,
    task: Task,
    record: MissionRecord,
    checkpoint: Parameters,
    now_ns: int,
) -> None:
    """A mission ended; one that was to be put back waits again, with what it has done."""
    if task.put_back and record.outcome == "cancelled":
        _wait_again(connection, task, checkpoint)
    else:
        finish(connection, task, record.outcome or "failed", record.failure, record.reason, now_ns)


def _wait_again(connection: Connection, task: Task, checkpoint: Parameters) -> None:
    waits = {"state": "queued", "put_back": False, "checkpoint": checkpoint, "attempt": task.attempt + 1}
    write_task(connection, task.model_copy(update=waits))
