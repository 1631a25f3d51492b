"""Which waiting task goes to which free robot: the shortest way first, among tasks whose turn is near. Pure.

A fleet that keeps strictly to the queue drives past tasks that begin next to it. Here as many tasks of a map
as robots share it compete for each free robot, and none is overtaken more often than there are other robots:
one robot alone keeps to the queue.
"""

import math
from collections import Counter
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from services.fleet.condition import Condition
from shared.messages.tasks import Task


@dataclass(frozen=True)
class Robot:
    """One robot as it is now.

    Attributes:
        lasts_s: for how long its condition has been of this kind.
        map: in which it was last on a mission; "" where nobody knows.
        node: of that map at which it is; None where nobody knows.
        has_tasks: something waits or runs in its own queue, as it says.
    """

    name: str
    condition: Condition
    lasts_s: float = 0.0
    map: str = ""
    node: int | None = None
    has_tasks: bool = False


@dataclass(frozen=True)
class Move:
    """Put a task into the queue `to`, a robot's or that of the fleet.

    Attributes:
        overtaken: ids of tasks that have waited longer for a robot.
    """

    task: Task
    to: str
    why: str
    overtaken: tuple[str, ...] = ()


Way = Callable[[Task, Robot], float]
"""Metres from where a robot is to where a task begins; infinite where nobody knows."""


def choose(
    waiting: Iterable[Task],
    free: Iterable[Robot],
    robots: Sequence[Robot],
    working: Container[str],
    way_m: Way,
    overtaken: Mapping[str, int],
) -> Iterator[Move]:
    """Give tasks to free robots until no robot is left that may take one.

    Args:
        waiting: tasks that no robot has, in the order of the queue.
        free: robots that can take one now; each gets one at most.
        robots: all that were heard of.
        working: names of those that have a task of the fleet.
        way_m: asked only of robots in the map of the task.
        overtaken: how often tasks that wait were overtaken so far, by id.
    """
    left, idle, counts = list(waiting), list(free), Counter(overtaken)
    sharing = [robot for robot in robots if _shares(robot, working)]
    while True:
        pairs = [
            (_way_m(task, robot, way_m), left.index(task), robot.name, robot)
            for task in _whose_turn_is_near(left, sharing, counts)
            for robot in _able(task, idle, robots)
        ]
        if not pairs:
            return
        metres, place, _, robot = min(pairs, key=lambda pair: pair[:3])
        task = left.pop(place)
        idle.remove(robot)
        passed = tuple(earlier.task_id for earlier in left[:place] if earlier.map == task.map)
        counts.update(passed)
        yield Move(task, robot.name, _told(metres), passed)


def _shares(robot: Robot, working: Container[str]) -> bool:
    """Whether it takes tasks, now or after the one that it has; who drives something else does not."""
    return robot.condition.is_ready or (robot.condition.kind == "kept" and robot.name in working)


def _whose_turn_is_near(
    left: Sequence[Task], sharing: Sequence[Robot], counts: Counter[str]
) -> Iterator[Task]:
    """Of each map the first tasks of the highest priority, as many as robots share it."""
    for name in dict.fromkeys(task.map for task in left):
        here = [task for task in left if task.map == name]
        others = len(_able(here[0], sharing, sharing)) - 1
        for task in here[: others + 1]:
            if task.priority != here[0].priority:
                break
            yield task
            if counts[task.task_id] >= others:
                break  # nothing overtakes it any more


def _able(task: Task, robots: Sequence[Robot], known: Sequence[Robot]) -> list[Robot]:
    """Those of the robots that may be in the task's map; all, where none that is heard of may be."""

    def may_be_there(robot: Robot) -> bool:
        return robot.map in ("", task.map)

    if not any(may_be_there(robot) for robot in known if robot.condition.kind != "silent"):
        return list(robots)
    return [robot for robot in robots if may_be_there(robot)]


def _way_m(task: Task, robot: Robot, way_m: Way) -> float:
    return way_m(task, robot) if robot.map == task.map and robot.node is not None else math.inf


def _told(metres: float) -> str:
    return "the way there is not known" if metres == math.inf else f"{metres:.1f} m away"
