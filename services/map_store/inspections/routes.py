"""REST: rounds of inspections, what changed in each, their pictures, and a page with both of each place."""

from typing import Annotated, Any

from fastapi import APIRouter, Path, Query
from fastapi.responses import HTMLResponse, Response
from pydantic import BaseModel

from services.map_store.api.names import MapName
from services.map_store.errors import MissingError
from services.map_store.inspections.report import Shown, page
from services.map_store.inspections.store import InspectionStore
from shared.messages.inspections import Inspection, Region
from shared.messages.places import PlaceName

RoundId = Annotated[
    str,
    Path(alias="round", pattern=r"^[A-Za-z0-9_-]{1,64}-[0-9]{1,9}$", description="mission and round, m1-3"),
]

PlaceOf = Annotated[PlaceName, Query(description="name of a place of the round")]
Before = Annotated[bool, Query(description="the picture that it was compared with")]
JPEG: dict[int | str, dict[str, Any]] = {200: {"content": {"image/jpeg": {}}}}


class VisitView(BaseModel):
    """A place in a round; bearings in the frame of the camera that took its picture.

    Attributes:
        against_ns: when the picture that it was compared with was taken; None where it was not.
        why: why it was not compared.
        changes: regions that changed.
    """

    place: str
    robot: str
    stamp_ns: int
    against_ns: int | None
    why: str
    inliers: int
    yaw_rad: float | None
    disparity_rad: float | None
    changes: list[Region]


class RoundView(BaseModel):
    """One round; `changes` counts those of all its places."""

    round: str
    mission_id: str
    number: int
    stamp_ns: int
    changes: int
    visits: list[VisitView]


def build(visits: InspectionStore) -> APIRouter:
    """Routes below /maps/{map}/inspections."""
    router = APIRouter(prefix="/maps/{map}/inspections", tags=["inspections"])

    @router.get("")
    def list_rounds(name: MapName) -> list[RoundView]:
        """All rounds that are kept, the newest first."""
        return [_round_view(each) for each in visits.rounds(name)]

    @router.get("/{round}")
    def show_round(name: MapName, round_id: RoundId) -> RoundView:
        """One round: its places and what changed at each."""
        return _round_view(visits.round(name, *_parts(round_id)))

    @router.get("/{round}/report", response_class=HTMLResponse)
    def show_report(name: MapName, round_id: RoundId) -> HTMLResponse:
        """One round as a page: both pictures of every place, turned alike, changes marked."""
        shown = []
        for visit in visits.round(name, *_parts(round_id)):
            earlier = None
            if visit.against_ns is not None:
                earlier = visits.visit_at(name, visit.place, visit.against_ns)
            shown.append(Shown(visit, earlier))
        return HTMLResponse(page(name, round_id, shown))

    @router.get("/{round}/picture", response_class=Response, responses=JPEG)
    def show_picture(name: MapName, round_id: RoundId, place: PlaceOf, before: Before = False) -> Response:
        """The picture of one place, or the one that it was compared with, as their cameras took them."""
        visit = visits.visit_in(name, *_parts(round_id), place)
        if visit is not None and before:
            at_ns = visit.against_ns
            visit = None if at_ns is None else visits.visit_at(name, place, at_ns)
        if visit is None:
            which = "picture from before" if before else "picture"
            raise MissingError(f"map {name!r}: round {round_id} has no {which} of {place!r} (any more)")
        headers = {"Cache-Control": "private, no-cache", "X-Content-Type-Options": "nosniff"}
        return Response(visit.picture, media_type="image/jpeg", headers=headers)

    return router


def _parts(round_id: str) -> tuple[str, int]:
    mission_id, _, number = round_id.rpartition("-")
    return mission_id, int(number)


def _round_view(visits: list[Inspection]) -> RoundView:
    first = visits[0]
    return RoundView(
        round=f"{first.mission_id}-{first.round}",
        mission_id=first.mission_id,
        number=first.round,
        stamp_ns=first.stamp_ns,
        changes=sum(len(each.regions) for each in visits),
        visits=[_visit_view(each) for each in visits],
    )


def _visit_view(visit: Inspection) -> VisitView:
    return VisitView(
        place=visit.place,
        robot=visit.robot,
        stamp_ns=visit.stamp_ns,
        against_ns=visit.against_ns,
        why=visit.why,
        inliers=visit.inliers,
        yaw_rad=visit.yaw_rad,
        disparity_rad=visit.disparity_rad,
        changes=list(visit.regions),
    )
