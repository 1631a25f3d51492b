"""Merging: add the places of another map to one, connected where both saw the same."""

from typing import Annotated, Any

from fastapi import APIRouter, Depends, Request, Response
from pydantic import BaseModel, ConfigDict, Field
from starlette.requests import HTTPConnection

from services.gateway.http.bodies import read_json
from services.gateway.http.map_store_proxy import author_of
from services.gateway.merging.desk import MergeDesk
from services.gateway.merging.job import MergeAnswer
from services.gateway.merging.reading import ReadMap, read_map
from services.gateway.state import GatewayDep, MapPath
from shared.web.problems import ProblemError

router = APIRouter(tags=["maps"])


class StartMerge(BaseModel):
    """Body of a start."""

    model_config = ConfigDict(extra="forbid", frozen=True)

    other: str = Field(pattern=r"^[a-z0-9_-]{1,64}$")


UNSIGNED = "gateway"
_CONTENT = {"application/json": {"schema": StartMerge.model_json_schema()}}
BODY: dict[str, Any] = {"requestBody": {"required": True, "content": _CONTENT}}


def desk_of(connection: HTTPConnection) -> MergeDesk:
    """The application's merges, for routes."""
    desk = connection.app.state.merges
    assert isinstance(desk, MergeDesk)
    return desk


MergesDep = Annotated[MergeDesk, Depends(desk_of)]


@router.post("/api/maps/{map_name}/merge", status_code=202, openapi_extra=BODY)
async def start_merge(
    request: Request, map_name: MapPath, gateway: GatewayDep, merges: MergesDep, response: Response
) -> MergeAnswer:
    """Start adding another map to this one; it takes about as long as matching all of its places."""
    wish = await read_json(request, StartMerge, gateway.settings.upload_timeout_s)
    if wish.other == map_name:
        raise ProblemError(
            422, "same_map", expected="two maps", got=f"{map_name} twice", next_step="name another map"
        )
    base, other = await read_map(gateway, map_name), await read_map(gateway, wish.other)
    _check_pipelines(base, other)
    response.headers["Location"] = f"/api/maps/{map_name}/merge"
    return merges.start(base, other, author_of(request) or UNSIGNED)


@router.get("/api/maps/{map_name}/merge")
async def show_merge(map_name: MapPath, merges: MergesDep) -> MergeAnswer:
    """The running or last merge into a map."""
    return merges.look(map_name)


@router.delete("/api/maps/{map_name}/merge")
async def cancel_merge(map_name: MapPath, merges: MergesDep) -> MergeAnswer:
    """Cancel the running merge into a map; nothing is written then."""
    return await merges.cancel(map_name)


def _check_pipelines(base: ReadMap, other: ReadMap) -> None:
    used = sorted(base.places.pipelines() | other.places.pipelines())
    if len(used) > 1:
        raise ProblemError(
            409,
            "pipelines_differ",
            expected="maps made by one pipeline",
            got=", ".join(used),
            next_step="map one of the places again with the other's pipeline",
        )
