"""The emergency stop: anybody engages it, without a token; an operator who gives a name clears it."""

import re
from typing import Annotated

from fastapi import APIRouter, Query, Request
from pydantic import AwareDatetime, BaseModel, ConfigDict, Field

from services.gateway.auth.guard import access_of, person_of
from services.gateway.http.bodies import MAX_JSON_BYTES, json_body, parse_json, read_body, read_json
from services.gateway.live.hub import facts_of
from services.gateway.routes.robots import known
from services.gateway.state import Gateway, GatewayDep, RobotPath
from shared.messages.estop import EStopRequest, EStopState
from shared.topics import ESTOP
from shared.web.problems import ProblemError

router = APIRouter(tags=["robots"])

TIMEOUT_S = 2.0
"""Chosen: drive answers within one of its steps; a person waits no longer before they press again."""
LONGEST_WHO, LONGEST_WHY = 64, 400
"""Characters, as `EStopRequest` has them."""
PATH = "/api/robots/{robot}/estop"
SLASHED = PATH + "/"
"""Answered as well: a redirect stops no robot of whoever does not follow it, as curl does not."""
STOP_PATH = re.compile(r"/api/robots/[^/]+/estop/?")
"""Served however many connections there are."""
BODY_S = 0.25
"""Chosen: a stop waits no longer for its reason, which usually comes with the head."""

Who = Annotated[str, Query(max_length=LONGEST_WHO, description="name of the person who looked")]


class Engage(BaseModel):
    """Body of a stop, which may be left out. A stop is never refused for it: see `warning`."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    who: str = "gateway"
    why: str = ""


class Clear(BaseModel):
    """Body of a clearance."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    who: str = Field(default="", max_length=LONGEST_WHO)
    why: str = Field(default="", max_length=LONGEST_WHY)


class EStopAnswer(BaseModel):
    """How it stands; `since` is the time of the last change by the robot's drive service, null before any.

    Attributes:
        warning: what was wrong with the body of a stop, which holds all the same; empty when nothing was.
    """

    robot: str
    engaged: bool
    who: str
    why: str
    since: AwareDatetime | None
    warning: str = ""


@router.get(PATH)
@router.get(SLASHED, include_in_schema=False)
async def show_estop(robot: RobotPath, gateway: GatewayDep) -> EStopAnswer:
    """Whether the emergency stop is engaged, by whom and why."""
    return _answer(await _ask(gateway, robot, EStopRequest(action="status")))


@router.post(PATH, openapi_extra=json_body(Engage, required=False))
@router.post(SLASHED, include_in_schema=False)
async def engage_estop(request: Request, robot: RobotPath, gateway: GatewayDep) -> EStopAnswer:
    """Stop the robot now; it stands until a person clears the stop, whatever restarts."""
    wish, warning = await _reason(request)
    who = signed(wish.who, person_of(request).name)
    engage = EStopRequest(action="engage", who=who, why=wish.why[:LONGEST_WHY])
    if access_of(request).rates.stop(robot):
        state = await _ask(gateway, robot, engage)
    else:
        state = await gateway.stops.join(robot, lambda: _ask(gateway, robot, engage))
    return _answer(state, warning)


@router.delete(PATH, openapi_extra=json_body(Clear, required=False))
@router.delete(SLASHED, include_in_schema=False)
async def clear_estop(request: Request, robot: RobotPath, gateway: GatewayDep, who: Who = "") -> EStopAnswer:
    """Let the robot go: `who` names the person who saw that it may. A paused mission stays paused."""
    wish = Clear()
    if "content-type" in request.headers:
        wish = await read_json(request, Clear, gateway.settings.upload_timeout_s)
    name = (wish.who or who).strip()
    if not name:
        expected = "the name of the person who clears the stop, in the body or as ?who="
        next_step = "look whether the robot may move, then clear it in your name"
        raise ProblemError(422, "who_required", expected, "none", next_step)
    person = signed(name, person_of(request).name)
    return _answer(await _ask(gateway, robot, EStopRequest(action="clear", who=person, why=wish.why)))


async def _reason(request: Request) -> tuple[Engage, str]:
    """Who stops and why, and what is wrong with that: then nobody is named, and the stop holds."""
    try:
        body = await read_body(request, MAX_JSON_BYTES, BODY_S)
        return (parse_json(body, Engage) if body.strip() else Engage()), ""
    except ProblemError as problem:
        return Engage(), f"stopped without who and why, as the body could not be read: {problem.detail}"[:400]


def signed(who: str, token: str) -> str:
    """What somebody says to be called, and what is known of them: only that stands in brackets."""
    said = who.replace("(", "").replace(")", "").strip()
    known_as = f" (token {token})" if token and token != said else ""
    return said[: LONGEST_WHO - len(known_as)] + known_as


async def _ask(gateway: Gateway, robot: str, request: EStopRequest) -> EStopState:
    asker = gateway.asker_for(robot)
    if request.action == "engage" and asker is gateway.asker:
        asker = gateway.stop_asker
    try:
        return await asker.ask("drive", ESTOP, request, TIMEOUT_S, robot=robot)
    except ProblemError as problem:
        if problem.code == "service_absent" and robot != gateway.settings.robot:
            known(gateway, robot)  # a robot nobody heard of is a better reason than a missing drive service
        raise


def _answer(state: EStopState, warning: str = "") -> EStopAnswer:
    return EStopAnswer(**facts_of(state), warning=warning)
