"""How well a goal picture localises in a map."""

from typing import Any

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict

from services.gateway.http.bodies import PICTURE_TYPES
from services.gateway.state import GatewayDep, MapQuery, RobotPath
from services.gateway.uploads.goal import Goal, goal_of
from services.gateway.uploads.places import Places, Verdict, places_of
from shared.mapgraph.local.hypotheses import COMPARED_NODES
from shared.messages.matching import MatchReply, MatchRequest
from shared.topics import MATCH

router = APIRouter(tags=["goals"])

SHOWN = 5
"""Nodes in an answer; chosen: as many as fit beside the picture in the console."""

FILE = {"type": "string", "format": "binary"}
PICTURE_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "description": "an equirectangular panorama, exactly 2:1",
        "content": {
            **{kind: {"schema": FILE} for kind in PICTURE_TYPES},
            "multipart/form-data": {"schema": {"type": "object", "properties": {"picture": FILE}}},
        },
    }
}


class NodeAnswer(BaseModel):
    """How the picture relates to one node; radians, counter-clockwise, 0 at the picture's centre."""

    model_config = ConfigDict(from_attributes=True)

    node_id: int
    raw_matches: int
    inliers: int
    status: str
    confidence: float
    heading_rad: float | None
    heading_std_rad: float | None
    yaw_rad: float | None
    disparity_rad: float | None


class PictureAnswer(BaseModel):
    """What was understood of the picture."""

    format: str
    width_px: int
    height_px: int
    keypoints: int


class PlaceAnswer(BaseModel):
    """Where the picture can have been taken: nodes of one place, and their matches together."""

    model_config = ConfigDict(from_attributes=True)

    nodes: list[int]
    similarity: int
    support: int


class GoalAnswer(BaseModel):
    """The best nodes first.

    found: the picture was taken at one place of the map; ambiguous: at one of several that look alike, see
    `places`; weak: it resembles nodes less than a picture taken there would; not_found: it resembles none.
    """

    robot: str
    map: str
    map_revision: int
    pipeline: str
    picture: PictureAnswer
    verdict: Verdict
    max_similarity: int
    places: list[PlaceAnswer]
    nodes: list[NodeAnswer]


@router.post("/api/robots/{robot}/goal-check", openapi_extra=PICTURE_BODY)
async def check_goal(
    request: Request, robot: RobotPath, map_name: MapQuery, gateway: GatewayDep
) -> GoalAnswer:
    """Say where in the map the uploaded picture was taken."""
    goal = await goal_of(request, gateway, robot)
    question = MatchRequest(map=map_name, features=goal.features, best_k=COMPARED_NODES, with_matches=False)
    timeout_s = gateway.settings.compute_timeout_s
    reply = await gateway.asker_for(robot).ask("features", MATCH, question, timeout_s, robot=robot)
    return _answer(robot, goal, reply, await places_of(gateway, reply))


def _answer(robot: str, goal: Goal, reply: MatchReply, places: Places) -> GoalAnswer:
    nodes = sorted(reply.results, key=lambda node: (node.inliers, node.confidence), reverse=True)
    return GoalAnswer(
        robot=robot,
        map=reply.map,
        map_revision=reply.map_revision,
        pipeline=reply.pipeline,
        picture=PictureAnswer(**goal.header._asdict(), keypoints=len(goal.features.lonlat_rad)),
        verdict=places.verdict,
        max_similarity=reply.max_similarity,
        places=[PlaceAnswer.model_validate(place) for place in places.likely],
        nodes=[NodeAnswer.model_validate(node) for node in nodes[:SHOWN]],
    )
