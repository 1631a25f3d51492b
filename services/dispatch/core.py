"""What to do next about the tasks of one robot. Pure: everything it remembers stands in the map store.

So this process may end at any moment, and two of it say the same. The planner takes one mission at a time,
and the map store lets a task begin only while it waits: asked twice, a mission is begun once.
"""

from dataclasses import dataclass, replace
from typing import Literal

from shared.messages.missions import MissionStatus
from shared.messages.tasks import Task, TaskReply
from shared.robots.seen import Seen, kept_by

Action = Literal["wait", "begin", "resume", "cancel", "go_home"]
HOME = "home"
"""The kind of mission that brings a robot to its place of that name."""


@dataclass(frozen=True)
class Limits:
    """Of the charge of the battery, as shares of a full one.

    Attributes:
        low: with less the robot goes home.
        resume: with this much again it goes on.
    """

    low: float
    resume: float


@dataclass(frozen=True)
class Step:
    """The next thing to do.

    Attributes:
        task: what it is about; for "go_home" the task to make.
        why: what the queue waits for; "" where it waits for nothing.
        on_hold: nothing is begun but the way home.
        alarm: what a person has to look after.
    """

    action: Action = "wait"
    task: Task | None = None
    why: str = ""
    on_hold: bool = False
    alarm: str = ""


def next_step(queue: TaskReply, seen: Seen, limits: Limits) -> Step:
    """What to do now."""
    on_hold = is_on_hold(queue, seen.charge, limits)
    step = _step(queue, seen, limits, on_hold)
    alarm = _alarm(queue) if on_hold else ""
    if queue.damaged and not alarm:
        alarm = f"{queue.damaged} records of tasks or schedules are damaged: see 'topnav map check'"
    return replace(step, on_hold=on_hold, alarm=alarm)


def is_on_hold(queue: TaskReply, charge: float | None, limits: Limits) -> bool:
    """Whether the last thing that the robot began was to go home for its battery, which is still low."""
    latest = queue.latest
    return latest is not None and latest.for_battery and (charge is None or charge < limits.resume)


def _step(queue: TaskReply, seen: Seen, limits: Limits, on_hold: bool) -> Step:
    running = next((task for task in queue.tasks if task.state == "running"), None)
    status = seen.status
    if status is None:
        return Step(why="nothing is heard of the planner")
    low = seen.charge is not None and seen.charge < limits.low
    if status.state in ("running", "paused"):
        if running is None or running.mission_id != status.mission_id:
            return Step(why=f"mission {status.mission_id} is {status.state}")
        return _under_way(running, status, seen, low)
    if running is not None and running.mission_id == status.mission_id:
        return Step(why=f"the end of {running.task_id} is being recorded")
    if not queue.tasks:
        return Step()
    if (why := kept_by(seen)) is not None:
        return Step(why=why)
    first = _first(queue)
    if first.for_battery or not (low or on_hold):
        return Step("begin", first)
    if on_hold:
        return Step(why=_charging(seen.charge, limits))
    return Step("go_home", way_home(first), why=f"the battery is at {seen.charge:.0%}")


def _first(queue: TaskReply) -> Task:
    """The task to begin: one that the planner does not know to be running, or the first that waits."""
    waiting = [task for task in queue.tasks if task.state == "queued"]
    running = [task for task in queue.tasks if task.state == "running" and not (task.put_back and waiting)]
    return (running or waiting)[0]


def _under_way(task: Task, status: MissionStatus, seen: Seen, low: bool) -> Step:
    """A task runs: go on after an emergency stop, or leave it for the battery."""
    if task.put_back:
        return Step("cancel", task, why="it goes back into the queue")
    if low and not task.for_battery:
        return Step("go_home", way_home(task), why=f"the battery is at {seen.charge:.0%}")
    if status.state == "paused" and status.paused_by == "emergency_stop" and kept_by(seen) is None:
        return Step("resume", task)
    return Step(why=status.reason if status.state == "paused" else "")


def way_home(task: Task) -> Task:
    """The task that brings the robot home in the map of `task`; the map store gives it its id."""
    return Task(task_id=HOME, robot=task.robot, kind=HOME, map=task.map, priority=9)


def _charging(charge: float | None, limits: Limits) -> str:
    known = "unknown" if charge is None else f"{charge:.0%}"
    return f"the battery is at {known}: on hold until {limits.resume:.0%}"


def _alarm(queue: TaskReply) -> str:
    """Of a robot that should have gone home and did not."""
    latest = queue.latest
    if latest is None or latest.state not in ("failed", "cancelled"):
        return ""
    return f"the battery is low and the robot did not get home: {latest.reason}"[:200]
