"""How well a goal picture localises in a map."""

from typing import Annotated, Any

from fastapi import APIRouter, Request
from fastapi import Query as UrlQuery
from pydantic import BaseModel, ConfigDict

from services.gateway.http.bodies import PICTURE_TYPES
from services.gateway.state import GatewayDep, MapQuery, RobotPath
from services.gateway.uploads.goal import Goal, goal_of
from services.gateway.uploads.photo import FIELD_OF_VIEW_DEG
from services.gateway.uploads.photo_places import LocatedPhoto
from services.gateway.uploads.places import Places, Verdict, places_of
from shared.mapgraph.local.hypotheses import COMPARED_NODES, Hypothesis
from shared.messages.matching import MatchReply, MatchRequest
from shared.topics import MATCH

router = APIRouter(tags=["goals"])

SHOWN = 5
"""Nodes in an answer; chosen: as many as fit beside the picture in the console."""

FieldOfView = Annotated[
    float | None,
    UrlQuery(
        ge=FIELD_OF_VIEW_DEG[0],
        le=FIELD_OF_VIEW_DEG[1],
        description="Over the longer side of an ordinary photo, degrees; else by EXIF, or found.",
    ),
]

FILE = {"type": "string", "format": "binary"}
PICTURE_BODY: dict[str, Any] = {
    "requestBody": {
        "required": True,
        "description": "an equirectangular panorama, exactly 2:1, or an ordinary photo",
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


class PhotoPlaceAnswer(BaseModel):
    """Where a photo can have been taken, as from its nearest node: x ahead of that node's camera, y left.

    Attributes:
        yaw_rad: which way the photo looks, counter-clockwise from where the node's camera looks.
        keypoints: of the photo that it explains; score: evidence, nats.
    """

    model_config = ConfigDict(from_attributes=True)

    node: int
    x_m: float
    y_m: float
    yaw_rad: float
    fov_rad: float
    keypoints: int
    score: float


class PhotoFinding(BaseModel):
    """What was found of an ordinary photo, the likeliest place first.

    Attributes:
        fov_known: its field of view was told, by its EXIF or its sender; else it was found.
    """

    fov_known: bool
    places: list[PhotoPlaceAnswer]


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
    photo: PhotoFinding | None = None


@router.post("/api/robots/{robot}/goal-check", openapi_extra=PICTURE_BODY)
async def check_goal(
    request: Request,
    robot: RobotPath,
    map_name: MapQuery,
    gateway: GatewayDep,
    field_of_view_deg: FieldOfView = None,
) -> GoalAnswer:
    """Say where in the map the uploaded panorama or photo was taken, and which way a photo looks."""
    goal = await goal_of(request, gateway, robot, map_name, field_of_view_deg)
    if goal.photo is not None:
        return _photo_answer(robot, goal, goal.photo)
    question = MatchRequest(map=map_name, features=goal.features, best_k=COMPARED_NODES, with_matches=False)
    timeout_s = gateway.settings.compute_timeout_s
    reply = await gateway.asker_for(robot).ask("features", MATCH, question, timeout_s, robot=robot)
    return _answer(robot, goal, reply, await places_of(gateway, reply))


def _photo_answer(robot: str, goal: Goal, found: LocatedPhoto) -> GoalAnswer:
    answer, places = found.answer, found.answer.places
    likely = [Hypothesis((p.node,), p.keypoints, p.keypoints, p.keypoints) for p in places]
    told = _answer(robot, goal, found.reply, Places(answer.verdict, likely))
    view = goal.features.photo
    finding = PhotoFinding(
        fov_known=view is not None and view.fov_known,
        places=[PhotoPlaceAnswer.model_validate(place) for place in places],
    )
    return told.model_copy(update={"photo": finding})


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
