"""Schedules of a robot: tasks that are made again and again."""

import time
from typing import Annotated

from fastapi import APIRouter, Path, Request
from pydantic import BaseModel, ConfigDict, Field

from services.gateway.http.bodies import json_body, read_json
from services.gateway.routes.queues import ScheduleAnswer, ask_queue, check_errand
from services.gateway.routes.tasks import AskedErrand
from services.gateway.state import GatewayDep, RobotPath
from shared.messages.tasks import Schedule, TaskReply, TaskRequest
from shared.schedules.due_times import EXAMPLE, DueTimes, ScheduleError
from shared.web.problems import ProblemError

router = APIRouter(tags=["tasks"])

NamePath = Annotated[str, Path(pattern=r"^[a-z0-9_-]{1,40}$", description="name of a schedule")]


class PutSchedule(BaseModel):
    """Body of a schedule.

    Attributes:
        cron: minute, hour, day of the month, month, day of the week: "30 7 * * MON-FRI".
        time_zone: IANA name, such as Europe/Zurich.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    cron: str = Field(min_length=1, max_length=100)
    time_zone: str = Field(default="UTC", min_length=1, max_length=64)
    task: AskedErrand
    enabled: bool = True


@router.get("/api/robots/{robot}/schedules")
async def list_schedules(robot: RobotPath, gateway: GatewayDep) -> list[ScheduleAnswer]:
    """The robot's schedules by name, with their next due times."""
    reply = await ask_queue(gateway, robot, TaskRequest(action="read"))
    return [ScheduleAnswer.of(schedule, time.time_ns()) for schedule in reply.schedules]


@router.get("/api/robots/{robot}/schedules/{name}")
async def show_schedule(robot: RobotPath, name: NamePath, gateway: GatewayDep) -> ScheduleAnswer:
    """One schedule."""
    return _named(await ask_queue(gateway, robot, TaskRequest(action="read")), name)


@router.put("/api/robots/{robot}/schedules/{name}", openapi_extra=json_body(PutSchedule))
async def put_schedule(
    request: Request, robot: RobotPath, name: NamePath, gateway: GatewayDep
) -> ScheduleAnswer:
    """Set a schedule: at each due time from now on it adds its task to the queue."""
    wish = await read_json(request, PutSchedule, gateway.settings.upload_timeout_s)
    _check_times(wish)
    errand = wish.task.errand()
    await check_errand(gateway, robot, errand)
    schedule = Schedule(
        name=name, robot=robot, cron=wish.cron, time_zone=wish.time_zone, task=errand, enabled=wish.enabled
    )
    return _named(
        await ask_queue(gateway, robot, TaskRequest(action="put_schedule", schedule=schedule)), name
    )


@router.delete("/api/robots/{robot}/schedules/{name}", status_code=204)
async def remove_schedule(robot: RobotPath, name: NamePath, gateway: GatewayDep) -> None:
    """Remove a schedule; tasks that it made stay."""
    await ask_queue(gateway, robot, TaskRequest(action="remove_schedule", name=name))


def _check_times(wish: PutSchedule) -> None:
    try:
        due_ns = DueTimes(wish.cron, wish.time_zone).next(time.time_ns())
    except ScheduleError as error:
        got, next_step = str(error)[:300], "correct the text of cron or the time zone"
        raise ProblemError(422, "bad_schedule", "a schedule in cron form", got, next_step) from None
    if due_ns is None:
        next_step = f"write it as in {EXAMPLE}"
        raise ProblemError(422, "bad_schedule", "a time that comes", f"never: {wish.cron}", next_step)


def _named(reply: TaskReply, name: str) -> ScheduleAnswer:
    for schedule in reply.schedules:
        if schedule.name == name:
            return ScheduleAnswer.of(schedule, time.time_ns())
    expected, next_step = f"a schedule of {reply.robot}", f"see /api/robots/{reply.robot}/schedules"
    raise ProblemError(404, "no_such_schedule", expected, name, next_step)
