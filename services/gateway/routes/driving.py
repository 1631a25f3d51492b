"""Driving by hand: a person's wish, said again for as long as they drive."""

from typing import Annotated, Literal

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict, Field

from services.gateway.auth.guard import person_of
from services.gateway.http.bodies import json_body, read_json
from services.gateway.routes.estop import signed
from services.gateway.routes.robots import known
from services.gateway.state import GatewayDep, RobotPath
from shared.messages.drive import Manual, Speed, TurnRate

router = APIRouter(tags=["robots"])

PATH = "/api/robots/{robot}/drive"


class Wish(BaseModel):
    """Body: how the robot is to move, in its own frame.

    Attributes:
        who: drives; of several people the first keeps the robot.
        action: "drive", or "release" to let it go at once.
        forward_mps, left_mps, turn_radps: drive slows down before what is near, and never touches it.
        ttl_ms: it stands so long after the last wish: say it three times as often.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)

    who: str = Field(min_length=1, max_length=64)
    action: Literal["drive", "release"] = "drive"
    forward_mps: Speed = 0.0
    left_mps: Speed = 0.0
    turn_radps: TurnRate = 0.0
    ttl_ms: Annotated[int, Field(ge=50, le=1_000)] = 400


class WishAnswer(BaseModel):
    """It was passed on; what the robot does of it says its velocity, in the live feed."""

    robot: str
    who: str


@router.post(PATH, status_code=202, openapi_extra=json_body(Wish))
async def drive_by_hand(request: Request, robot: RobotPath, gateway: GatewayDep) -> WishAnswer:
    """Drive; a mission that runs is paused until it is resumed. The emergency stop holds as ever."""
    wish = await read_json(request, Wish, gateway.settings.upload_timeout_s)
    if robot != gateway.settings.robot:
        known(gateway, robot)
    who = signed(wish.who, person_of(request).name)
    gateway.hands.wish(Manual(robot=robot, **{**wish.model_dump(), "who": who}))
    return WishAnswer(robot=robot, who=who)
