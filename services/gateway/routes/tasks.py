"""The queue of a robot: look, add, move, cancel."""

import uuid
from typing import Annotated

from fastapi import APIRouter, Path, Request, Response
from fastapi import Query as UrlQuery
from pydantic import BaseModel, ConfigDict, Field

from services.gateway.auth.guard import person_of
from services.gateway.http.bodies import json_body, read_json
from services.gateway.routes.missions import AnyParameters, Seed, Steps
from services.gateway.routes.queues import TaskAnswer, ask_queue, check_errand
from services.gateway.state import Gateway, GatewayDep, QueuePath
from shared.access.tokens import includes
from shared.messages.missions import CONTROLS, MissionRequest
from shared.messages.tasks import USUAL_PRIORITY, Errand, QueueStatus, Task, TaskRequest
from shared.topics import MISSION
from shared.transport.keys import ANY
from shared.web.problems import ProblemError

router = APIRouter(tags=["tasks"])

TaskPath = Annotated[str, Path(pattern=r"^[a-z0-9_.-]{1,56}$", description="id of a task")]
PriorityField = Annotated[int, Field(ge=0, le=9, description="Higher first.")]


class AskedErrand(BaseModel):
    """What a robot is to do.

    Attributes:
        kind: one of /api/robots/{robot}/mission-kinds.
        parameters: of the kind; the planner checks their values when the mission starts.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    kind: str = Field(pattern=r"^[a-z0-9_-]{1,64}$")
    map: str = Field(pattern=r"^[a-z0-9_-]{1,64}$")
    parameters: AnyParameters = Field(default_factory=dict)
    priority: PriorityField = USUAL_PRIORITY
    seed: Seed = 0
    max_steps: Steps = 20_000

    def errand(self) -> Errand:
        """The same for the bus.

        Raises:
            ProblemError: 422, a control is no kind of mission.
        """
        if self.kind in CONTROLS:
            expected, next_step = "a kind of mission", "choose one of /api/robots/{robot}/mission-kinds"
            raise ProblemError(422, "unknown_kind", expected, self.kind, next_step)
        return Errand(**{name: getattr(self, name) for name in Errand.model_fields})


class AddTask(AskedErrand):
    """Body of a new task.

    Attributes:
        task_id: of your choice, so that a request that is sent again adds no second task; else one is made.
    """

    task_id: str = Field(default="", pattern=r"^[a-z0-9_.-]{0,56}$")


class ChangeTask(BaseModel):
    """Body of a change."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    priority: PriorityField


class QueueAnswer(BaseModel):
    """Tasks that have not ended, in the order in which they begin, and the newest of those that have.

    Attributes:
        why: what the next task waits for, as the service says that hands the tasks out, dispatch of a robot's
            and fleet of any; "" for nothing, null if it is away.
        on_hold: the battery is low.
        alarm: what a person has to look after.
        damaged: records that cannot be read.
    """

    robot: str
    tasks: list[TaskAnswer]
    ended: list[TaskAnswer]
    why: str | None
    on_hold: bool
    alarm: str
    damaged: int


@router.get("/api/robots/{robot}/tasks")
async def list_tasks(
    robot: QueuePath, gateway: GatewayDep, ended: Annotated[int, UrlQuery(ge=0, le=200)] = 20
) -> QueueAnswer:
    """The robot's queue, and the newest tasks that ended."""
    reply = await ask_queue(gateway, robot, TaskRequest(action="read", ended=ended))
    told = _told(gateway, robot)
    return QueueAnswer(
        robot=robot,
        tasks=[TaskAnswer.of(task) for task in reply.tasks],
        ended=[TaskAnswer.of(task) for task in reply.ended],
        why=None if told is None else told.why,
        on_hold=told is not None and told.on_hold,
        alarm="" if told is None else told.alarm,
        damaged=reply.damaged,
    )


@router.post("/api/robots/{robot}/tasks", status_code=201, openapi_extra=json_body(AddTask))
async def add_task(request: Request, robot: QueuePath, gateway: GatewayDep, response: Response) -> TaskAnswer:
    """Put a task into the robot's queue; it begins when those before it have ended."""
    wish = await read_json(request, AddTask, gateway.settings.upload_timeout_s)
    errand = wish.errand()
    await check_errand(gateway, robot, errand)
    task_id = wish.task_id or f"t-{uuid.uuid4().hex[:12]}"
    fields = {name: getattr(errand, name) for name in Errand.model_fields}
    task = Task(task_id=task_id, robot=robot, by=person_of(request).name, **fields)
    response.headers["Location"] = f"/api/robots/{robot}/tasks/{task_id}"
    return await _about(gateway, robot, TaskRequest(action="add", task=task))


@router.get("/api/robots/{robot}/tasks/{task_id}")
async def show_task(robot: QueuePath, task_id: TaskPath, gateway: GatewayDep) -> TaskAnswer:
    """One task, also one of the last 200 that ended."""
    return await _about(gateway, robot, TaskRequest(action="read", task_id=task_id))


@router.patch("/api/robots/{robot}/tasks/{task_id}", openapi_extra=json_body(ChangeTask))
async def change_task(
    request: Request, robot: QueuePath, task_id: TaskPath, gateway: GatewayDep
) -> TaskAnswer:
    """Give a task that waits another priority."""
    wish = await read_json(request, ChangeTask, gateway.settings.upload_timeout_s)
    return await _about(
        gateway, robot, TaskRequest(action="prioritize", task_id=task_id, priority=wish.priority)
    )


@router.delete("/api/robots/{robot}/tasks/{task_id}")
async def cancel_task(
    request: Request, robot: QueuePath, task_id: TaskPath, gateway: GatewayDep
) -> TaskAnswer:
    """Cancel a task that waits; one that runs is cancelled with its mission, by an operator."""
    token = person_of(request).token
    for action in ("read", "cancel"):  # it may begin in between
        task = await _about(gateway, robot, TaskRequest(action=action, task_id=task_id))
        if task.state == "running" and token is not None and not includes(token.role, "operator"):
            expected, got = "role operator to cancel a task that runs", token.role
            next_step = "ask somebody who is operator"
            raise ProblemError(
                403, "role_too_low", expected, got, next_step, needed="operator", role=token.role
            )
    if task.state != "running":
        return task
    wish = MissionRequest(action="cancel", map=task.map, mission_id=task.mission_id)
    whose, timeout_s = task.robot, gateway.settings.ask_timeout_s
    await gateway.asker_for(whose).ask("planner", MISSION, wish, timeout_s, robot=whose)
    return await _about(gateway, robot, TaskRequest(action="read", task_id=task_id))


def _told(gateway: Gateway, robot: str) -> QueueStatus | None:
    """What is said of a queue by the process that looks after it; None while that is away."""
    if robot == ANY:
        return gateway.hub.fleet if gateway.hub.services.get("fleet") else None
    view = gateway.hub.robots.get(robot)
    return view.queue if view is not None and gateway.hub.services.get("dispatch") else None


async def _about(gateway: Gateway, robot: str, request: TaskRequest) -> TaskAnswer:
    task = (await ask_queue(gateway, robot, request)).task
    if task is None:
        next_step = f"see /api/robots/{robot}/tasks"
        raise ProblemError(404, "no_such_task", f"a task of {robot}", request.task_id, next_step)
    return TaskAnswer.of(task)
