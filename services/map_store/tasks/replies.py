"""What a queue looks like, as it is answered to whoever asked something of it."""

from sqlalchemy import Connection

from services.map_store.tasks.following import ENDED
from services.map_store.tasks.records import latest_begun, newest_ended, of_the_fleet, schedules_of, tasks_in
from shared.messages.tasks import OPEN_STATES, Task, TaskReply
from shared.transport.keys import ANY


def in_order(task: Task) -> tuple[bool, bool, int, int, str]:
    """Sorts tasks that have not ended: what runs, the way home, then by priority and age."""
    waits = task.state != "running"
    return waits, not task.for_battery, -task.priority, task.created_ns, task.task_id


def reply_of(connection: Connection, robot: str, about: Task | None, ended: int) -> TaskReply:
    """The queue of a robot or of the fleet, with the task `about` and at most so many that ended."""
    if robot == ANY:
        return _of_the_fleet(connection, about, ended)
    tasks, damaged = tasks_in(connection, robot, OPEN_STATES)
    timetable, torn = schedules_of(connection, robot)
    return TaskReply(
        robot=robot,
        tasks=tuple(sorted(tasks, key=in_order)),
        ended=tuple(newest_ended(connection, robot, ENDED, ended)) if ended else (),
        latest=latest_begun(connection, robot),
        task=about,
        schedules=tuple(timetable),
        damaged=damaged + torn,
    )


def _of_the_fleet(connection: Connection, about: Task | None, ended: int) -> TaskReply:
    tasks, damaged = of_the_fleet(connection, OPEN_STATES)
    over = sorted(of_the_fleet(connection, ENDED)[0], key=lambda t: (-t.ended_ns, t.task_id)) if ended else []
    waiting = tuple(sorted(tasks, key=in_order))
    return TaskReply(robot=ANY, tasks=waiting, ended=tuple(over[:ended]), task=about, damaged=damaged)
