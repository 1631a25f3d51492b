"""Where a robot is, by its newest picture alone."""

from fastapi import APIRouter
from pydantic import BaseModel

from services.gateway.routes.evidence import Turn, compared_live
from services.gateway.routes.goals import PlaceAnswer
from services.gateway.state import GatewayDep, MapQuery, RobotPath
from services.gateway.uploads.places import Verdict, places_of
from shared.mapgraph.local.hypotheses import COMPARED_NODES

router = APIRouter(tags=["robots"])


class Whereabouts(BaseModel):
    """Where in the map the newest picture can have been taken, the likeliest place first.

    Attributes:
        frame_seq: of the picture.
        verdict: as of a goal picture: found, ambiguous, weak or not_found.
    """

    robot: str
    map: str
    map_revision: int
    frame_seq: int
    verdict: Verdict
    places: list[PlaceAnswer]


@router.get("/api/robots/{robot}/whereabouts")
async def show_whereabouts(
    robot: RobotPath, map_name: MapQuery, gateway: GatewayDep, _turn: Turn
) -> Whereabouts:
    """Where the robot is in the map: what its picture says, without what it knows of its way."""
    frame, reply = await compared_live(gateway, robot, map_name, best_k=COMPARED_NODES)
    places = await places_of(gateway, reply)
    return Whereabouts(
        robot=robot,
        map=reply.map,
        map_revision=reply.map_revision,
        frame_seq=frame.seq,
        verdict=places.verdict,
        places=[PlaceAnswer.model_validate(place) for place in places.likely],
    )
