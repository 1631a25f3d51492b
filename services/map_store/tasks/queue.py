"""The queue of each robot: what waits, in which order, and what may still be changed."""

from collections.abc import Callable
from typing import TypeVar

import msgpack
from sqlalchemy import Connection

from services.map_store.errors import ConflictError, InvalidError, MapError, MissingError
from services.map_store.storage.database import Database
from services.map_store.tasks.fleet import find_in_fleet, move, refuse_taken
from services.map_store.tasks.following import finish
from services.map_store.tasks.records import find_task, tasks_in, write_task
from services.map_store.tasks.replies import reply_of
from services.map_store.tasks.timetable import make_due, put_schedule, take_schedule
from shared.messages.tasks import OPEN_STATES, Errand, Task, TaskReply, TaskRequest
from shared.transport.keys import ANY, check_queue

T = TypeVar("T")

WAITING = 200
"""Tasks of one robot that may wait: more are days of work; chosen."""
OF_THE_FLEET = ("read", "add", "cancel", "prioritize", "move")
"""What can be asked of the fleet's queue: nobody goes home in it, nor does it make schedules due."""
ERRAND_BYTES, ERRAND_VALUES = 8_000, 200
"""Longest parameters of a task: a patrol of 64 places has a third; an answer holds all tasks of a robot."""


class TaskStore:
    """Tasks and schedules by robot in `database`.

    Args:
        now_ns: clock, nanoseconds since the Unix epoch.
    """

    def __init__(self, database: Database, now_ns: Callable[[], int]) -> None:
        self._database, self._now_ns = database, now_ns

    def answer(self, robot: str, request: TaskRequest) -> TaskReply:
        """Do what `request` asks of the queue of `robot`; raises MapError, and then nothing was changed."""
        try:
            check_queue(robot)
        except ValueError as error:
            raise InvalidError(str(error)) from None
        if robot == ANY and request.action not in OF_THE_FLEET:
            raise InvalidError(f"the fleet's queue knows {', '.join(OF_THE_FLEET)}, got {request.action}")
        if request.action == "read":
            with self._database.read() as connection:
                about = _find(connection, robot, request.task_id) if request.task_id else None
                return reply_of(connection, robot, about, request.ended)
        with self._database.write() as connection:
            about = self._change(connection, robot, request)
            return reply_of(connection, robot, about, request.ended)

    def _change(self, connection: Connection, robot: str, request: TaskRequest) -> Task | None:
        now_ns = self._now_ns()
        match request.action:
            case "add":
                return _add(connection, robot, _given(request.task, "task"), now_ns)
            case "cancel":
                return _cancel(connection, _found(connection, robot, request.task_id), now_ns)
            case "prioritize":
                waiting = _waiting(_found(connection, robot, request.task_id))
                return _written(connection, waiting.model_copy(update={"priority": request.priority}))
            case "refuse":
                task = _found(connection, robot, request.task_id)
                return _refuse(connection, task, request.reason, now_ns)
            case "go_home":
                return _go_home(connection, robot, _given(request.task, "task"), now_ns)
            case "put_schedule":
                schedule = _given(request.schedule, "schedule")
                _check_errand(schedule.task)
                put_schedule(connection, schedule.model_copy(update={"robot": robot}), now_ns)
            case "remove_schedule":
                take_schedule(connection, robot, request.name)
            case "make_due":
                return make_due(connection, robot, request, now_ns)
            case "move":
                return move(connection, robot, request.task_id, request.to)
        return None


def _add(connection: Connection, robot: str, wanted: Task, now_ns: int) -> Task:
    """Put a task into the queue; the same one again is the one that is there."""
    known = _find(connection, robot, wanted.task_id)
    if known is not None:
        if any(getattr(known, name) != getattr(wanted, name) for name in ("kind", "map", "parameters")):
            raise ConflictError(f"there is another task {wanted.task_id!r} already: choose another id")
        return known
    refuse_taken(connection, robot, wanted.task_id)
    _check_errand(wanted)
    waiting = len(tasks_in(connection, robot, ["queued"])[0])
    if waiting >= WAITING:
        raise ConflictError(f"{waiting} tasks wait for {robot}, and no more may: cancel some")
    made = {"robot": robot, "fleet": robot == ANY, "by": wanted.by, "created_ns": now_ns}
    errand = {name: getattr(wanted, name) for name in Errand.model_fields}
    task = Task.model_validate({"task_id": wanted.task_id, **made, **errand})
    return _written(connection, task)


def _cancel(connection: Connection, task: Task, now_ns: int) -> Task:
    """Take a task out of the queue; one that runs stays as it is: its mission must be cancelled."""
    if task.state == "running":  # and must not come back then
        return _written(connection, task.model_copy(update={"put_back": False}))
    if task.state == "queued":
        return finish(connection, task, "cancelled", "cancelled", "cancelled while it waited", now_ns)
    if task.state != "cancelled":
        raise _over(task)
    return task


def _refuse(connection: Connection, task: Task, reason: str, now_ns: int) -> Task:
    """A task that waited has failed; one that was begun or cancelled meanwhile stays as it is."""
    if task.state != "queued":
        return task
    tried = task.model_copy(update={"started_ns": now_ns})
    return finish(connection, tried, "failed", "refused", reason, now_ns)


def _go_home(connection: Connection, robot: str, home: Task, now_ns: int) -> Task:
    """Have what runs wait again once its mission is cancelled, and the way home be next; once is enough."""
    tasks, _ = tasks_in(connection, robot, OPEN_STATES)
    for task in tasks:
        if task.state == "running" and not task.for_battery:
            write_task(connection, task.model_copy(update={"put_back": True}))
    ways = [task for task in tasks if task.for_battery]
    if ways:
        return ways[0]
    wanted = {"robot": robot, "state": "queued", "for_battery": True, "created_ns": now_ns}
    wanted["task_id"] = f"home-{now_ns // 1_000_000}"
    return _written(connection, home.model_copy(update=wanted))


def _check_errand(errand: Errand) -> None:
    size = len(msgpack.packb(errand.parameters))
    if size > ERRAND_BYTES or _values(errand.parameters) > ERRAND_VALUES:
        most = f"{ERRAND_VALUES} values in {ERRAND_BYTES} bytes"
        raise InvalidError(f"parameters of a task may be {most} at most, got {size} bytes")


def _values(value: object) -> int:
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else ()
    return 1 + sum(map(_values, inner))


def _find(connection: Connection, robot: str, task_id: str) -> Task | None:
    """A task of this queue; of the fleet's also one that a robot has."""
    if robot == ANY:
        return find_in_fleet(connection, task_id)
    return find_task(connection, robot, task_id)


def _found(connection: Connection, robot: str, task_id: str) -> Task:
    task = _find(connection, robot, task_id)
    if task is None:
        raise MissingError(f"{'the fleet' if robot == ANY else robot} has no task {task_id!r}")
    return task


def _waiting(task: Task) -> Task:
    if task.state == "running":
        raise ConflictError(f"task {task.task_id!r} runs already: its priority means nothing any more")
    if task.state != "queued":
        raise _over(task)
    return task


def _over(task: Task) -> MapError:
    return ConflictError(f"task {task.task_id!r} is over ({task.state})")


def _written(connection: Connection, task: Task) -> Task:
    write_task(connection, task)
    return task


def _given(thing: T | None, what: str) -> T:
    if thing is None:
        raise InvalidError(f"a {what} expected, got none")
    return thing
