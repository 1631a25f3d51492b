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
from shared.messages.matching import MatchRequest
from shared.topics import MAP, MATCH
from shared.web.problems import ProblemError

router = APIRouter(tags=["evidence"])

LIVE_TRIES, LIVE_PAUSE_S = 5, 0.1
"""The feature service may not have the newest frame yet, or have dropped it for a newer one; chosen."""


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
    return await _matches(gateway, settings.robot, question, f"node {a}")


@router.get("/api/robots/{robot}/matches")
async def show_live_matches(
    robot: RobotPath, map_name: MapQuery, node: NodeQuery, gateway: GatewayDep, _turn: Turn
) -> Matches:
    """Compare the newest picture with a node."""
    left = LIVE_TRIES
    while True:
        left -= 1
        frame = newest_frame(gateway, robot)
        question = MatchRequest(seq=frame.seq, stamp_ns=frame.stamp_ns, map=map_name, node_ids=(node,))
        try:
            return await _matches(gateway, robot, question, f"frame {frame.seq}")
        except ProblemError as problem:
            if problem.members.get("reason") != "passing" or not left:
                raise
        await asyncio.sleep(LIVE_PAUSE_S)


async def _matches(gateway: Gateway, robot: str, question: MatchRequest, picture: str) -> Matches:
    timeout_s = gateway.settings.compute_timeout_s
    reply = await gateway.asker_for(robot).ask("features", MATCH, question, timeout_s, robot=robot)
    match = next((found for found in reply.results if found.node_id in question.node_ids), None)
    if match is None:
        expected = f"matches of node {question.node_ids[0]}"
        raise bad_answer("features", expected, f"{len(reply.results)} others")
    bearings = [] if match.matches_rad is None else match.matches_rad.astype(float).round(5).tolist()
    inlier = [] if match.inlier_mask is None else match.inlier_mask.astype(bool).tolist()
    return Matches(
        **vars(NodeAnswer.model_validate(match)), picture=picture, matches_rad=bearings, inlier=inlier
    )
