"""Missions: start, steer, look, wait."""

import asyncio
import contextlib
import time
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Request, Response
from fastapi import Query as UrlQuery
from pydantic import BaseModel, ConfigDict, Field, WithJsonSchema

from services.gateway.http.asking import Q, R
from services.gateway.http.bodies import json_body, read_json
from services.gateway.live.hub import RobotView
from services.gateway.routes.goals import PICTURE_BODY, FieldOfView
from services.gateway.routes.robots import known
from services.gateway.state import Gateway, GatewayDep, MapQuery, RobotPath
from services.gateway.uploads.goal import goal_of
from shared.messages.missions import (
    CONTROLS,
    MissionKindInfo,
    MissionKindsRequest,
    MissionRequest,
    MissionStatus,
    Parameters,
)
from shared.topics import MISSION, MISSION_KINDS, Query
from shared.web.problems import ProblemError

router = APIRouter(tags=["missions"])

TERMINAL = frozenset({"idle", "succeeded", "failed", "cancelled"})
ASK_AGAIN_S = 5.0
"""While waiting, the status is also asked for: the last message may have been lost with a process."""
UNHEARD_S = 0.5
"""Of a robot that said nothing yet there are no news to wait for: it is asked so often."""

Seed = Annotated[int, Field(ge=0, lt=2**63)]
Steps = Annotated[int, Field(ge=1, le=1_000_000)]
MissionId = Annotated[str, UrlQuery(max_length=64)]


AnyParameters = Annotated[
    Parameters, WithJsonSchema({"type": "object", "additionalProperties": True, "maxProperties": 64})
]
"""Described without a reference, which the description of a body read by hand could not resolve."""


class StartMission(BaseModel):
    """Body of a start. A goto by picture goes to /missions/goto instead.

    Attributes:
        action: the kind of mission, one of /api/robots/{robot}/mission-kinds.
        parameters: of the kind; the planner checks them.
        goal_node: the parameter of that name.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    action: str = Field(pattern=r"^[a-z0-9_-]{1,64}$")
    map: str = Field(pattern=r"^[a-z0-9_-]{1,64}$")
    seed: Seed = 0
    parameters: AnyParameters = Field(default_factory=dict)
    goal_node: int | None = Field(default=None, ge=0, lt=2**63)
    max_steps: Steps = 20_000


@router.get("/api/robots/{robot}/mission-kinds")
async def show_kinds(robot: RobotPath, gateway: GatewayDep) -> list[MissionKindInfo]:
    """What the robot can be asked to do: kinds of mission, with a JSON Schema of their parameters."""
    return list((await _ask_planner(gateway, robot, MISSION_KINDS, MissionKindsRequest())).kinds)


class WaitAnswer(BaseModel):
    """Where the mission stands; `done` says whether it came to an end."""

    done: bool
    mission: dict[str, Any]


@router.post("/api/robots/{robot}/missions", status_code=202, openapi_extra=json_body(StartMission))
async def start(
    request: Request, robot: RobotPath, gateway: GatewayDep, response: Response
) -> dict[str, Any]:
    """Start a mission of a kind that the planner knows, with its parameters."""
    wish = await read_json(request, StartMission, gateway.settings.upload_timeout_s)
    if wish.action in CONTROLS:
        expected, next_step = (
            "a kind of mission",
            f"steer with POST /api/robots/{robot}/missions/{wish.action}",
        )
        raise ProblemError(422, "invalid_request", expected, wish.action, next_step)
    response.headers["Location"] = f"/api/robots/{robot}/mission"
    return _facts(await _start(gateway, robot, MissionRequest(**wish.model_dump())))


@router.post("/api/robots/{robot}/missions/goto", status_code=202, openapi_extra=PICTURE_BODY)
async def start_goto(
    request: Request,
    robot: RobotPath,
    map_name: MapQuery,
    gateway: GatewayDep,
    response: Response,
    seed: Annotated[int, UrlQuery(ge=0, lt=2**63)] = 0,
    max_steps: Annotated[int, UrlQuery(ge=1, le=1_000_000)] = 20_000,
    field_of_view_deg: FieldOfView = None,
) -> dict[str, Any]:
    """Drive to where the uploaded picture was taken, and look as it does if it is an ordinary photo."""
    goal = await goal_of(request, gateway, robot, map_name, field_of_view_deg)
    wish = MissionRequest(action="goto", map=map_name, goal=goal.features, seed=seed, max_steps=max_steps)
    response.headers["Location"] = f"/api/robots/{robot}/mission"
    return _facts(await _start(gateway, robot, wish))


@router.post("/api/robots/{robot}/missions/{action}")
async def steer(
    robot: RobotPath,
    action: Literal["pause", "resume", "cancel", "finish"],
    gateway: GatewayDep,
    mission_id: MissionId = "",
) -> dict[str, Any]:
    """Pause, resume, cancel or finish the robot's mission, or only the one named.

    Finished are missions that go along with a person who drives, such as `teach`.
    """
    return _facts(await _ask(gateway, robot, MissionRequest(action=action, mission_id=mission_id)))


@router.get("/api/robots/{robot}/mission")
async def look(robot: RobotPath, gateway: GatewayDep) -> dict[str, Any]:
    """The robot's current or last mission."""
    return _facts(await _ask(gateway, robot, MissionRequest(action="status")))


@router.get("/api/robots/{robot}/mission/wait")
async def wait(
    robot: RobotPath,
    gateway: GatewayDep,
    timeout_s: Annotated[float, UrlQuery(ge=0.0, le=300.0)] = 30.0,
    mission_id: MissionId = "",
) -> WaitAnswer:
    """Answer when the mission ends, or after `timeout_s` with `done` false: then ask again."""
    deadline_s = time.monotonic() + timeout_s
    while True:
        view = gateway.hub.robots.get(robot)
        news = view.changed if view else None  # from before the question: an end may be told meanwhile
        status = await _ask_patiently(gateway, robot, deadline_s)
        done = _ended(status, mission_id)
        left_s = deadline_s - time.monotonic()
        if done or left_s <= 0.0:
            return WaitAnswer(done=done, mission=_facts(status))
        if view is None or news is None:
            await asyncio.sleep(min(left_s, UNHEARD_S))
            continue
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(min(left_s, ASK_AGAIN_S)):
                await _next_end(view, news, mission_id)


async def _next_end(view: RobotView, news: asyncio.Event, mission_id: str) -> None:
    """Return when a status, of which `news` tells first, says the mission ended."""
    while True:
        await news.wait()
        news = view.changed
        if view.status is not None and _ended(view.status, mission_id):
            return


def _ended(status: MissionStatus, mission_id: str) -> bool:
    """Another mission in place of the one waited for means that one is over too."""
    return status.state in TERMINAL or bool(mission_id and status.mission_id not in ("", mission_id))


async def _ask_patiently(gateway: Gateway, robot: str, deadline_s: float) -> MissionStatus:
    """Ask for the status; a planner that restarts meanwhile gets until the deadline to come back."""
    while True:
        try:
            return await _ask(gateway, robot, MissionRequest(action="status"))
        except ProblemError as problem:
            gone = problem.status_code in (503, 504)
            if not gone or time.monotonic() + 0.5 > deadline_s:
                raise
        await asyncio.sleep(0.5)


async def _start(gateway: Gateway, robot: str, wish: MissionRequest) -> MissionStatus:
    status = await _ask(gateway, robot, wish)
    gateway.missions.ordered(status, wish.seed)
    return status


async def _ask(gateway: Gateway, robot: str, wish: MissionRequest) -> MissionStatus:
    outcome = "failed"
    try:
        status = await _ask_planner(gateway, robot, MISSION, wish)
        outcome = "accepted"
        return status
    except ProblemError as problem:
        outcome = problem.code
        raise
    finally:
        if wish.action != "status":
            known_name = outcome == "accepted" or wish.action in CONTROLS  # a label from outside has no bound
            gateway.metrics.missions.labels(wish.action if known_name else "start", outcome).inc()


async def _ask_planner(gateway: Gateway, robot: str, query: Query[Q, R], question: Q) -> R:
    timeout_s = gateway.settings.ask_timeout_s
    try:
        return await gateway.asker_for(robot).ask("planner", query, question, timeout_s, robot=robot)
    except ProblemError as problem:
        if problem.code == "service_absent" and robot != gateway.settings.robot:
            known(gateway, robot)  # a robot nobody heard of is a better reason than a missing planner
        raise


def _facts(status: MissionStatus) -> dict[str, Any]:
    return status.model_dump(mode="json")
