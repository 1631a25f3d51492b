"""Rows of tasks and schedules: what they say is kept whole, under a checksum; a damaged one is left out."""

from collections.abc import Iterable, Sequence
from typing import Any, TypeVar

from pydantic import ValidationError
from sqlalchemy import Connection, Row, Table, delete, insert, select

from services.map_store.integrity.seals import intact, matches, sealed
from services.map_store.storage.blobs import checksum
from services.map_store.storage.tables import schedules, tasks
from shared.messages.base import Part
from shared.messages.tasks import Schedule, Task, TaskState
from shared.transport.keys import ANY

P = TypeVar("P", bound=Part)


def write_task(connection: Connection, task: Task) -> None:
    """Keep `task` in the place of what was known of it."""
    content = task.model_dump_json().encode()
    values = {
        "robot": task.robot,
        "task_id": task.task_id,
        "state": task.state,
        "started_ns": task.started_ns,
        "ended_ns": task.ended_ns,
        "sha256": checksum(content),
    }
    remove_task(connection, task.robot, task.task_id)
    connection.execute(insert(tasks).values({**sealed(tasks, values), "content": content}))


def remove_task(connection: Connection, robot: str, task_id: str) -> None:
    """Forget it, where it is there."""
    connection.execute(delete(tasks).where(tasks.c.robot == robot, tasks.c.task_id == task_id))


def find_task(connection: Connection, robot: str, task_id: str) -> Task | None:
    """The task of that id; None where there is none, or a damaged record."""
    same = tasks.c.robot == robot, tasks.c.task_id == task_id
    row = connection.execute(select(tasks).where(*same)).first()
    return None if row is None else task_of(row)


def tasks_in(connection: Connection, robot: str, states: Iterable[TaskState]) -> tuple[list[Task], int]:
    """Tasks of a robot that are in one of these states, and how many such records are damaged."""
    chosen = tasks.c.robot == robot, tasks.c.state.in_(tuple(states))
    return _readable(connection.execute(select(tasks).where(*chosen)).all())


def newest_ended(connection: Connection, robot: str, states: Sequence[TaskState], most: int) -> list[Task]:
    """At most `most` tasks in one of these states, those that ended last first."""
    chosen = select(tasks).where(tasks.c.robot == robot, tasks.c.state.in_(states))
    newest = chosen.order_by(tasks.c.ended_ns.desc(), tasks.c.task_id).limit(most)
    return _readable(connection.execute(newest).all())[0]


def of_the_fleet(connection: Connection, states: Iterable[TaskState]) -> tuple[list[Task], int]:
    """Tasks for whichever robot in one of these states, and how many records of ANY are damaged."""
    rows = connection.execute(select(tasks).where(tasks.c.state.in_(tuple(states)))).all()
    damaged = sum(row.robot == ANY and task_of(row) is None for row in rows)
    return [task for task in _readable(rows)[0] if task.fleet], damaged


def find_anywhere(connection: Connection, task_id: str) -> list[Task]:
    """The tasks of that id, of whichever robot."""
    return _readable(connection.execute(select(tasks).where(tasks.c.task_id == task_id)).all())[0]


def latest_begun(connection: Connection, robot: str) -> Task | None:
    """The task that was begun last, whatever became of it."""
    begun = select(tasks).where(tasks.c.robot == robot, tasks.c.started_ns > 0)
    row = connection.execute(begun.order_by(tasks.c.started_ns.desc()).limit(1)).first()
    return None if row is None else task_of(row)


def write_schedule(connection: Connection, schedule: Schedule) -> None:
    """Keep `schedule` in the place of the one of its name."""
    content = schedule.model_dump_json().encode()
    values = {"robot": schedule.robot, "name": schedule.name, "sha256": checksum(content)}
    remove_schedule(connection, schedule.robot, schedule.name)
    connection.execute(insert(schedules).values({**sealed(schedules, values), "content": content}))


def remove_schedule(connection: Connection, robot: str, name: str) -> None:
    """Forget it, where it is there."""
    connection.execute(delete(schedules).where(schedules.c.robot == robot, schedules.c.name == name))


def schedules_of(connection: Connection, robot: str) -> tuple[list[Schedule], int]:
    """Schedules of a robot by name, and how many records are damaged."""
    chosen = select(schedules).where(schedules.c.robot == robot).order_by(schedules.c.name)
    rows = connection.execute(chosen).all()
    found = [schedule for row in rows if (schedule := schedule_of(row)) is not None]
    return found, len(rows) - len(found)


def task_of(row: Row[Any]) -> Task | None:
    """What a row says; None where it or what it should say is damaged."""
    return _content(Task, tasks, row)


def schedule_of(row: Row[Any]) -> Schedule | None:
    """What a row says; None where it or what it should say is damaged."""
    return _content(Schedule, schedules, row)


def damaged(connection: Connection) -> list[str]:
    """Names of all records that cannot be read, of all robots."""
    bad = [
        f"task {row.task_id!r} of {row.robot!r}"
        for row in connection.execute(select(tasks)).all()
        if task_of(row) is None
    ]
    rows = connection.execute(select(schedules)).all()
    return bad + [f"schedule {row.name!r} of {row.robot!r}" for row in rows if schedule_of(row) is None]


def mend(connection: Connection) -> int:
    """Remove records that cannot be read; how many."""
    lost = 0
    for table, read in ((tasks, task_of), (schedules, schedule_of)):
        for row in connection.execute(select(table)).all():
            if read(row) is None:
                same = (column == row._mapping[column.name] for column in table.primary_key)
                connection.execute(delete(table).where(*same))
                lost += 1
    return lost


def follow_rename(connection: Connection, name: str, new_name: str) -> None:
    """Have tasks and schedules in a map be in the map of its new name."""
    change = {"map": new_name}
    for row in connection.execute(select(tasks)).all():
        task = task_of(row)
        if task is not None and task.map == name and task.state in ("queued", "running"):
            write_task(connection, task.model_copy(update=change))
    for row in connection.execute(select(schedules)).all():
        schedule = schedule_of(row)
        if schedule is not None and schedule.task.map == name:
            errand = schedule.task.model_copy(update=change)
            write_schedule(connection, schedule.model_copy(update={"task": errand}))


def _content(kind: type[P], table: Table, row: Row[Any]) -> P | None:
    if not (intact(table, row) and matches(row.content, row.sha256)):
        return None
    try:
        return kind.model_validate_json(row.content)
    except ValidationError:  # of a program that had other rules
        return None


def _readable(rows: Sequence[Row[Any]]) -> tuple[list[Task], int]:
    found = [task for row in rows if (task := task_of(row)) is not None]
    return found, len(rows) - len(found)
