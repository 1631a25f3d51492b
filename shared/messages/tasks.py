"""Tasks of a robot: missions that wait for their turn, schedules that make some. Everyone -> map store."""

from typing import Annotated, ClassVar, Literal

from pydantic import Field

from shared.messages.base import Message, Name, Part
from shared.messages.missions import Parameters

TaskState = Literal["queued", "running", "succeeded", "failed", "cancelled"]
OPEN_STATES: tuple[TaskState, ...] = ("queued", "running")
"""Of a task that has not ended."""

TaskId = Annotated[str, Field(pattern=r"^[a-z0-9_.-]{1,56}$")]
ScheduleName = Annotated[str, Field(pattern=r"^[a-z0-9_-]{1,40}$")]
Priority = Annotated[int, Field(ge=0, le=9)]
"""Higher first."""
Moment = Annotated[int, Field(ge=0, lt=2**63)]
"""By the wall clock, nanoseconds since the Unix epoch; 0: never, or not yet."""

USUAL_PRIORITY = 4
AGAIN = "~"
"""In no id of a task: what follows it counts attempts."""


class Errand(Part):
    """What a robot is to do: a mission of some kind, with its parameters."""

    kind: Name
    map: Name = "default"
    parameters: Parameters = Field(default_factory=dict)
    priority: Priority = USUAL_PRIORITY
    seed: int = Field(default=0, ge=0, lt=2**63)
    max_steps: int = Field(default=20_000, ge=1, le=1_000_000)


class Task(Errand):
    """One errand in the queue of a robot. The mission that carries it out has its id, see `mission_id`.

    Attributes:
        state: of the mission, once it was begun.
        failure: a `FailureKind`, or "refused": the planner did not take it.
        attempt: how often it went back into the queue.
        checkpoint: how far it had got then.
        put_back: it goes back into the queue when its mission is cancelled.
        for_battery: it brings a robot home that has little charge left.
        schedule: what made it, at `due_ns`; "" for a task that somebody asked for.
        by: who asked for it.
        fleet: it is for whichever robot; `robot` is the one that has it now, or ANY while none has.
        created_ns, started_ns, ended_ns: by the clock of the map store.
    """

    task_id: TaskId
    robot: Name
    state: TaskState = "queued"
    failure: str = Field(default="", max_length=32)
    reason: str = Field(default="", max_length=400)
    attempt: int = Field(default=0, ge=0, le=999_999)
    checkpoint: Parameters = Field(default_factory=dict)
    put_back: bool = False
    for_battery: bool = False
    schedule: str = Field(default="", pattern=r"^[a-z0-9_-]{0,40}$")
    by: str = Field(default="", max_length=64)
    fleet: bool = False
    due_ns: Moment = 0
    created_ns: Moment = 0
    started_ns: Moment = 0
    ended_ns: Moment = 0

    @property
    def mission_id(self) -> str:
        """Of the mission that carries it out: another one each time, as each has an end of its own."""
        return f"{self.task_id}{AGAIN}{self.attempt}" if self.attempt else self.task_id


def task_id_of(mission_id: str) -> str:
    """The id of the task that a mission carries out, if it carries out one."""
    return mission_id.partition(AGAIN)[0]


class Schedule(Part):
    """When a task is to be made, again and again.

    Attributes:
        cron: minute, hour, day of the month, month, day of the week.
        time_zone: IANA name of the zone whose clocks `cron` means.
        task: what is made.
        handled_ns: due times until then have made a task or were skipped, and make none any more.
        skipped: how often none was made: while nothing ran, or as the task of an earlier time still waited.
        skipped_ns: when that was last.
    """

    name: ScheduleName
    robot: Name
    cron: str = Field(min_length=1, max_length=100)
    time_zone: str = Field(default="UTC", min_length=1, max_length=64)
    task: Errand
    enabled: bool = True
    handled_ns: Moment = 0
    skipped_ns: Moment = 0
    skipped: int = Field(default=0, ge=0, lt=2**63)


class TaskRequest(Message):
    """Read or change queue and schedules of a robot, or the queue of the fleet. Asked again, it is done once.

    Attributes:
        action: read; add `task`; cancel a task that waits; prioritize one that waits; refuse one that waits,
            because the planner does; go_home: have the running task put back and `task` come first;
            put_schedule, remove_schedule; make_due: make the task of schedule `name` for `due_ns`, or `skip`;
            move: put a task of the fleet that waits in this queue into the queue `to`.
        to: a robot's name, or ANY.
        ended: how many tasks that ended the answer shall have.
    """

    SCHEMA: ClassVar[str] = "task_request.v1"
    MAX_ITEMS: ClassVar[int] = 10_000

    action: Literal[
        "read",
        "add",
        "cancel",
        "prioritize",
        "refuse",
        "go_home",
        "put_schedule",
        "remove_schedule",
        "make_due",
        "move",
    ]
    task_id: str = Field(default="", pattern=r"^[a-z0-9_.-]{0,56}$")
    task: Task | None = None
    priority: Priority = USUAL_PRIORITY
    reason: str = Field(default="", max_length=400)
    schedule: Schedule | None = None
    name: str = Field(default="", pattern=r"^[a-z0-9_-]{0,40}$")
    due_ns: Moment = 0
    skip: bool = False
    to: str = Field(default="", pattern=r"^[a-z0-9_-]{0,64}$")
    ended: int = Field(default=0, ge=0, le=200)


class TaskReply(Message):
    """The queue after the request.

    That of the fleet has every task that is for whichever robot, wherever it waits, runs or ended.

    Attributes:
        tasks: those that have not ended, the running one first, then in the order in which they will begin.
        ended: those that have, newest first; as many as were asked for.
        latest: the one that was begun last, or whose beginning was refused.
        task: the one that the request was about, None where it made none.
        damaged: records of this robot that cannot be read: "topnav map repair" removes them.
    """

    SCHEMA: ClassVar[str] = "task_reply.v1"
    MAX_ITEMS: ClassVar[int] = 200_000

    robot: Name
    tasks: tuple[Task, ...] = Field(default=(), fail_fast=True)
    ended: tuple[Task, ...] = Field(default=(), fail_fast=True)
    latest: Task | None = None
    task: Task | None = None
    schedules: tuple[Schedule, ...] = Field(default=(), fail_fast=True)
    damaged: int = Field(default=0, ge=0)


class QueueStatus(Message):
    """What the process that begins a robot's tasks is about, said once a second. Dispatch -> everyone.

    The process that hands out the fleet's says the same of ANY; `running` is then "" always.

    Attributes:
        waiting: tasks in the queue.
        running: id of the task under way; "" for none.
        why: what the next task waits for; "" while nothing keeps it.
        on_hold: the battery is low: nothing is begun but the way home.
        alarm: what a person has to look after; "" for nothing.
    """

    SCHEMA: ClassVar[str] = "queue_status.v1"

    robot: Name
    waiting: int = Field(default=0, ge=0)
    running: str = Field(default="", max_length=64)
    why: str = Field(default="", max_length=200)
    on_hold: bool = False
    alarm: str = Field(default="", max_length=200)
