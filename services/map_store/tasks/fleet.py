"""The queue of the fleet: tasks for whichever robot, handed to one and taken back while they wait.

A task of the fleet has an id that no other task has, whoever has it: so what is asked for it finds it
wherever it is, and a robot that lost it cannot begin it any more (`of_another`).
"""

from sqlalchemy import Connection

from services.map_store.errors import ConflictError, InvalidError, MissingError
from services.map_store.tasks.records import find_anywhere, remove_task, tasks_in, write_task
from shared.messages.tasks import Task
from shared.transport.keys import ANY, check_queue


def find_in_fleet(connection: Connection, task_id: str) -> Task | None:
    """The task of the fleet of that id, whichever robot has it; None where there is none."""
    return next((task for task in find_anywhere(connection, task_id) if task.fleet), None)


def of_another(connection: Connection, robot: str, task_id: str) -> Task | None:
    """The task of the fleet of that id, if another robot or none has it."""
    task = find_in_fleet(connection, task_id)
    return None if task is None or task.robot == robot else task


def refuse_taken(connection: Connection, queue: str, task_id: str) -> None:
    """See that a new task of `queue` leaves each id of the fleet to one task.

    Raises:
        ConflictError: another task has it.
    """
    others = find_anywhere(connection, task_id)
    if any(queue == ANY or other.fleet for other in others):
        raise ConflictError(
            f"there is another task {task_id!r} already, of {others[0].robot}: choose another id"
        )


def move(connection: Connection, source: str, task_id: str, target: str) -> Task:
    """Put a task that waits in the queue `source` into the queue `target`; one that is there already stays.

    Raises:
        InvalidError: `target` is no queue, or the task belongs to its robot.
        MissingError: there is no such task.
        ConflictError: it runs, is over, or another robot has it; or one that was handed over waits there
            already, or a task of its id is there.
    """
    try:
        check_queue(target)
    except ValueError as error:
        raise InvalidError(str(error)) from None
    found = find_anywhere(connection, task_id)
    task = next((one for one in found if one.fleet), None)
    if task is None:
        if any(one.robot == source for one in found):
            raise InvalidError(
                f"task {task_id!r} belongs to {source}: only tasks of the fleet are handed over"
            )
        raise MissingError(f"the fleet has no task {task_id!r}")
    if task.robot == target:
        return task
    _refuse_fixed(task, source)
    if target != ANY:
        _refuse_busy(connection, target)
    if any(one.robot == target for one in found):
        raise ConflictError(f"there is another task {task_id!r} of {target} already")
    remove_task(connection, task.robot, task_id)
    moved = task.model_copy(update={"robot": target})
    write_task(connection, moved)
    return moved


def _refuse_fixed(task: Task, source: str) -> None:
    """A task stays where it runs or ended, and is taken from nobody but the one who is thought to have it."""
    if task.state == "running":
        raise ConflictError(f"task {task.task_id!r} runs already: {task.robot} has begun it")
    if task.state != "queued":
        raise ConflictError(f"task {task.task_id!r} is over ({task.state})")
    if task.robot != source:
        raise ConflictError(f"task {task.task_id!r} is not with {source}: {task.robot} has it")


def _refuse_busy(connection: Connection, robot: str) -> None:
    """A robot has at most one task of the fleet that it has not begun, whoever hands them out."""
    for other in tasks_in(connection, robot, ["queued"])[0]:
        if other.fleet:
            raise ConflictError(f"task {other.task_id!r} was handed to {robot} and waits: one at a time")
