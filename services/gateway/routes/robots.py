"""Robots: who is there, what they see, what they say."""

import time
from typing import Annotated, Any

from fastapi import APIRouter, Query, Response
from pydantic import BaseModel

from services.gateway.live.hub import BODY, RobotView, facts_of
from services.gateway.live.snapshot import jpeg_of
from services.gateway.live.true_poses import Position
from services.gateway.state import Gateway, GatewayDep, MapQuery, RobotPath
from shared.messages.base import Message
from shared.messages.maps import MapRequest
from shared.messages.sensors import Frame
from shared.topics import MAP
from shared.web.problems import ProblemError

router = APIRouter(tags=["robots"])


class TruePositions(BaseModel):
    """Per node its x and y in metres and the yaw of its camera in radians, frame of the simulated world."""

    map: str
    positions: dict[int, Position]


@router.get("/api/robots")
async def list_robots(gateway: GatewayDep) -> list[dict[str, Any]]:
    """Robots heard of since the gateway started."""
    views = sorted(gateway.hub.robots.items())
    return [_facts(robot, view) for robot, view in views if view.seen_s > 0.0]


@router.get("/api/robots/{robot}")
async def show_robot(robot: RobotPath, gateway: GatewayDep) -> dict[str, Any]:
    """One robot: its newest frame's facts, mission, heading and ranges; what it says of its body, if any."""
    return _facts(robot, known(gateway, robot))


@router.get("/api/robots/{robot}/events")
async def list_events(
    robot: RobotPath, gateway: GatewayDep, limit: Annotated[int, Query(ge=1, le=200)] = 50
) -> list[dict[str, Any]]:
    """The newest decisions with their reasons, oldest first."""
    return [event.model_dump(mode="json") for event in list(known(gateway, robot).events)[-limit:]]


@router.get("/api/robots/{robot}/frame.jpg", response_class=Response)
async def show_frame(
    robot: RobotPath, gateway: GatewayDep, width: Annotated[int | None, Query(ge=64, le=4096)] = None
) -> Response:
    """The newest frame as JPEG, no wider than `width`."""
    view, frame = known(gateway, robot), newest_frame(gateway, robot)
    jpeg = await gateway.work(lambda: jpeg_of(frame, width))
    headers = {
        "Cache-Control": "no-store",
        "X-Frame-Seq": str(frame.seq),
        "X-Frame-Stamp-Ns": str(frame.stamp_ns),
        "X-Frame-Age-S": f"{time.monotonic() - view.frame_s:.3f}",
    }
    return Response(jpeg, headers=headers, media_type="image/jpeg")


@router.get("/api/robots/{robot}/truth")
async def show_truth(robot: RobotPath, gateway: GatewayDep) -> dict[str, Any]:
    """Debug view of the simulation: where the robot really is. No service steers by it."""
    truth = known(gateway, robot).truth
    if truth is None:
        got, next_step = f"no true pose of {robot}", "only the simulator publishes true poses"
        raise ProblemError(404, "no_truth", "a simulated robot", got, next_step)
    return truth.model_dump(mode="json")


@router.get("/api/robots/{robot}/true-positions")
async def show_true_positions(robot: RobotPath, map_name: MapQuery, gateway: GatewayDep) -> TruePositions:
    """Debug view of the simulation: where a map's nodes really are, as far as this gateway saw them made."""
    view, timeout_s = known(gateway, robot), gateway.settings.compute_timeout_s
    reply = await gateway.asker.ask("map_store", MAP, MapRequest(action="read"), timeout_s, map=map_name)
    return TruePositions(map=map_name, positions=view.true_poses.of_nodes(reply.nodes))


def newest_frame(gateway: Gateway, robot: str) -> Frame:
    """The robot's newest frame.

    Raises:
        ProblemError: 404, never heard of the robot, or no frame of it.
    """
    frame = known(gateway, robot).frame
    if frame is None:
        got, next_step = "none since the gateway started", "see whether its camera or the simulator runs"
        raise ProblemError(404, "no_frame", f"a frame of {robot}", got, f"{next_step} (/readyz)")
    return frame


def known(gateway: Gateway, robot: str) -> RobotView:
    """The robot's view.

    Raises:
        ProblemError: 404, never heard of it.
    """
    if not gateway.hub.knows(robot):
        names = sorted(filter(gateway.hub.knows, gateway.hub.robots))
        expected = f"one of {names}" if names else "a robot that was heard of"
        raise ProblemError(404, "unknown_robot", expected, robot, "see /api/robots")
    return gateway.hub.robots[robot]


def _facts(robot: str, view: RobotView) -> dict[str, Any]:
    now_s = time.monotonic()
    shown: dict[str, Message | None] = {"frame": view.frame, "estop": view.estop, "mission": view.status}
    shown |= {"heading": view.heading, "ranges": view.ranges}
    shown |= {kind: message for kind in BODY.values() if (message := getattr(view, kind)) is not None}
    facts = {name: None if message is None else facts_of(message) for name, message in shown.items()}
    if facts["frame"] is not None:
        facts["frame"]["age_s"] = round(now_s - view.frame_s, 3)
    return {"robot": robot, "seen_age_s": round(now_s - view.seen_s, 3), **facts}
