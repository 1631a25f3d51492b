"""Evidence for people: the matches behind an edge, and those between the live picture and a node."""

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated

from fastapi import APIRouter, Depends, Request

from services.gateway.auth.guard import access_of, person_of
from services.gateway.http.asking import bad_answer
from services.gateway.routes.goals import NodeAnswer
from services.gateway.routes.robots import newest_frame
from services.gateway.state import Gateway, GatewayDep, MapPath, MapQuery, NodePath, NodeQuery, RobotPath
from shared.messages.maps import MapRequest
from shared.messages.matching import MatchReply, MatchRequest
from shared.messages.sensors import Frame
from shared.topics import MAP, MATCH
from shared.web.problems import ProblemError

router = APIRouter(tags=["evidence"])

LIVE_TRIES, LIVE_PAUSE_S = 5, 0.1
"""The feature service may have dropped the newest frame for a newer one; chosen."""


class Matches(NodeAnswer):
    """How a picture relates to a node, with every match.

    Attributes:
        picture: "node 3" or "frame 512": whose bearings come first.
        matches_rad: longitude and latitude in the picture, then in the node.
        inlier: per match, whether it agrees with one motion of the camera.
    """

    picture: str
    matches_rad: list[tuple[float, float, float, float]]
    inlier: list[bool]


async def comparison(request: Request, gateway: GatewayDep) -> AsyncIterator[None]:
    """A turn at the feature service, which robots need more urgently than whoever looks on."""
    client = person_of(request).client
    access_of(request).rates.comparison(client)
    with gateway.comparisons.hold(client):
        yield


Turn = Annotated[None, Depends(comparison)]


@router.get("/api/maps/{map_name}/edges/{a}/{b}/matches")
async def show_edge_matches(
    map_name: MapPath, a: NodePath, b: NodePath, gateway: GatewayDep, _turn: Turn
) -> Matches:
    """Compare the pictures of two nodes again: what speaks for an edge between them."""
    settings = gateway.settings
    wish = MapRequest(action="read_features", node_ids=(a,))
    reply = await gateway.asker.ask("map_store", MAP, wish, settings.compute_timeout_s, map=map_name)
    if not reply.features:
        expected = f"node {a} of {map_name} with its features"
        raise ProblemError(404, "no_features", expected, "none", "see /api/maps/{map}/nodes")
    question = MatchRequest(map=map_name, features=reply.features[0].features, node_ids=(b,))
    return _facts(b, await _ask(gateway, settings.robot, question), f"node {a}")


@router.get("/api/robots/{robot}/matches")
async def show_live_matches(
    robot: RobotPath, map_name: MapQuery, node: NodeQuery, gateway: GatewayDep, _turn: Turn
) -> Matches:
    """Compare the newest picture with a node."""
    frame, reply = await compared_live(gateway, robot, map_name, node_ids=(node,))
    return _facts(node, reply, f"frame {frame.seq}")


async def compared_live(
    gateway: Gateway, robot: str, map_name: str, *, node_ids: tuple[int, ...] = (), best_k: int = 0
) -> tuple[Frame, MatchReply]:
    """The robot's newest frame, and how it relates to those nodes and to the `best_k` most similar ones.

    Raises:
        ProblemError: no such robot, no frame of it yet, or the feature service cannot tell.
    """
    left = LIVE_TRIES
    while True:
        left -= 1
        frame = newest_frame(gateway, robot)
        question = MatchRequest(
            seq=frame.seq,
            stamp_ns=frame.stamp_ns,
            map=map_name,
            node_ids=node_ids,
            best_k=best_k,
            with_matches=bool(node_ids),
        )
        try:
            return frame, await _ask(gateway, robot, question)
        except ProblemError as problem:
            if problem.members.get("reason") != "passing" or not left:
                raise
        await asyncio.sleep(LIVE_PAUSE_S)


async def _ask(gateway: Gateway, robot: str, question: MatchRequest) -> MatchReply:
    timeout_s = gateway.settings.compute_timeout_s
    return await gateway.asker_for(robot).ask("features", MATCH, question, timeout_s, robot=robot)


def _facts(node: int, reply: MatchReply, picture: str) -> Matches:
    match = next((found for found in reply.results if found.node_id == node), None)
    if match is None:
        raise bad_answer("features", f"matches of node {node}", f"{len(reply.results)} others")
    bearings = [] if match.matches_rad is None else match.matches_rad.astype(float).round(5).tolist()
    inlier = [] if match.inlier_mask is None else match.inlier_mask.astype(bool).tolist()
    return Matches(
        **vars(NodeAnswer.model_validate(match)), picture=picture, matches_rad=bearings, inlier=inlier
    )
