"""Which robot gets which task of the fleet. Pure: who has what stands in the map store and nowhere else.

So this process may end at any moment, and two of it say the same or are refused: a task is moved only from
where it waits, and a robot that begins it at that very moment keeps it.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from services.fleet.choice import Move, Robot, Way, choose
from shared.messages.tasks import Task
from shared.transport.keys import ANY


@dataclass(frozen=True)
class Limits:
    """What decides whether a robot gets a task and keeps it.

    Attributes:
        battery: share of a full charge; a robot with less gets none, and gives back what waits.
        silent_s, patience_s: so long one that says nothing, or that cannot begin, keeps what waits for it.
    """

    battery: float
    silent_s: float
    patience_s: float


@dataclass(frozen=True)
class Plan:
    """What to do now.

    Attributes:
        why: what the first task waits for that no robot gets; "" where none waits.
        alarm: what a person has to look after.
    """

    moves: tuple[Move, ...] = ()
    why: str = ""
    alarm: str = ""


def decide(
    tasks: Sequence[Task], robots: Iterable[Robot], way_m: Way, limits: Limits, overtaken: Mapping[str, int]
) -> Plan:
    """Take back what waits in vain, then give tasks that no robot has to robots that are free.

    Args:
        tasks: of the fleet that have not ended, in the order in which they are to begin.
        robots: all that were heard of, and all that have a task.
        way_m: asked only of robots in the map of the task.
        limits: what decides whether a robot gets a task and keeps it.
        overtaken: how often tasks that wait were overtaken so far, by id.
    """
    known = {robot.name: robot for robot in robots}
    moves = [move for task in tasks if (move := _taken_back(task, known, limits)) is not None]
    loaded = {task.robot for task in tasks}
    free = [r for r in known.values() if r.condition.is_ready and not r.has_tasks and r.name not in loaded]
    waiting = [task for task in tasks if task.state == "queued" and task.robot == ANY]
    given = list(choose(waiting, free, list(known.values()), loaded, way_m, overtaken))
    why = _waits_for(known) if len(given) < len(waiting) else ""
    return Plan((*moves, *given), why, _alarm(tasks, known, limits))


def _taken_back(task: Task, known: Mapping[str, Robot], limits: Limits) -> Move | None:
    """What is done about a task that waits in the queue of a robot; None where it stays."""
    robot = known.get(task.robot)
    if task.state != "queued" or robot is None:
        return None
    after_s = {"silent": limits.silent_s, "low": 0.0, "kept": limits.patience_s}
    condition = robot.condition
    if condition.is_ready or robot.lasts_s < after_s[condition.kind]:
        return None
    return Move(task, ANY, f"{robot.name}: {condition.why}")


def _waits_for(known: Mapping[str, Robot]) -> str:
    """Why no robot takes a task, by robot."""
    if not known:
        return "no robot is heard of"
    return "; ".join(f"{robot.name}: {_busy_with(robot)}" for robot in known.values())[:200]


def _busy_with(robot: Robot) -> str:
    return robot.condition.why or ("has tasks" if robot.has_tasks else "has one, or is in another map")


def _alarm(tasks: Iterable[Task], known: Mapping[str, Robot], limits: Limits) -> str:
    """Of robots that went silent with a task that they had begun: only they know what became of it."""
    lost = [
        f"{task.task_id} by {task.robot}"
        for task in tasks
        if task.state == "running"
        and (robot := known.get(task.robot)) is not None
        and robot.condition.kind == "silent"
        and robot.lasts_s >= limits.silent_s
    ]
    return f"begun, and nothing is heard of the robot since: {', '.join(lost)}"[:200] if lost else ""
