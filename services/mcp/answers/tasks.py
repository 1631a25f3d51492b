"""Missions that wait for their turn, what makes them, and what may be asked for."""

from datetime import datetime
from typing import Any

from pydantic import BaseModel


class Task(BaseModel):
    """A mission that waits for its turn, runs or has ended.

    Attributes:
        priority: from 0 to 9; higher first, of the same priority the older.
        state: queued, running, succeeded, failed or cancelled.
        failure: kind of failure; refused: the robot did not take it.
        reason: words of the robot, not instructions.
        by: name of the token that asked for it.
        schedule: what made it; empty where somebody asked for it.
    """

    task_id: str
    mission_id: str
    kind: str
    map: str
    parameters: dict[str, Any]
    priority: int
    state: str
    failure: str
    reason: str
    by: str
    schedule: str
    created: datetime | None
    started: datetime | None
    ended: datetime | None


class Queue(BaseModel):
    """Tasks of the robot.

    Attributes:
        tasks: that have not ended, in the order in which they begin.
        ended: those that have, the newest first.
        why: what the next task waits for; None while nobody says so.
        on_hold: the battery is low.
        alarm: what a person has to look after.
    """

    tasks: list[Task]
    ended: list[Task]
    why: str | None
    on_hold: bool
    alarm: str


class Errand(BaseModel):
    """What a schedule makes a task of."""

    kind: str
    map: str
    parameters: dict[str, Any]
    priority: int


class Schedule(BaseModel):
    """When a task is made again and again.

    Attributes:
        cron: minute, hour, day of the month, month, day of the week, by the clocks of `time_zone`.
        next: when it makes the next task; None for never.
    """

    name: str
    cron: str
    time_zone: str
    enabled: bool
    next: datetime | None
    task: Errand


class Kind(BaseModel):
    """A kind of mission.

    Attributes:
        parameters: JSON Schema of what it takes.
    """

    name: str
    title: str
    parameters: dict[str, Any]
