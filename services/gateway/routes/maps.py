"""Maps: passed through to the map store, so that a browser needs one address only."""

from typing import Any

from fastapi import APIRouter, Request
from fastapi.responses import Response

from services.gateway.http.bodies import MAX_JSON_BYTES, read_body
from services.gateway.http.map_store_proxy import forward, forward_stream
from services.gateway.state import Gateway, GatewayDep, MapPath

router = APIRouter(tags=["maps"])

ZIP: dict[int | str, dict[str, Any]] = {200: {"content": {"application/zip": {}}}}
JPEG: dict[int | str, dict[str, Any]] = {200: {"content": {"image/jpeg": {}}}}


@router.get("/api/maps")
async def list_maps(request: Request, gateway: GatewayDep) -> Response:
    """All maps."""
    return await forward(gateway, request, "/maps")


@router.post("/api/maps", status_code=201)
async def create_map(request: Request, gateway: GatewayDep) -> Response:
    """Make an empty map."""
    return await _with_body(gateway, request, "/maps")


@router.post("/api/maps/import", status_code=201)
async def import_map(request: Request, gateway: GatewayDep) -> Response:
    """Add a map from an archive made by export."""
    return await forward_stream(gateway, request, "/maps/import")


@router.get("/api/maps/{map_name}")
async def show_map(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """One map: its counts and revision."""
    return await forward(gateway, request, f"/maps/{map_name}")


@router.patch("/api/maps/{map_name}")
async def rename_map(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """Rename a map."""
    return await _with_body(gateway, request, f"/maps/{map_name}")


@router.delete("/api/maps/{map_name}", status_code=204)
async def delete_map(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """Delete a map."""
    return await forward(gateway, request, f"/maps/{map_name}")


@router.get("/api/maps/{map_name}/nodes")
async def list_nodes(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """Places of a map."""
    return await forward(gateway, request, f"/maps/{map_name}/nodes")


@router.get("/api/maps/{map_name}/nodes/{node_id:int}")
async def show_node(request: Request, map_name: MapPath, node_id: int, gateway: GatewayDep) -> Response:
    """One place."""
    return await forward(gateway, request, f"/maps/{map_name}/nodes/{node_id}")


@router.delete("/api/maps/{map_name}/nodes/{node_id:int}")
async def delete_node(request: Request, map_name: MapPath, node_id: int, gateway: GatewayDep) -> Response:
    """Delete a place and its edges."""
    return await forward(gateway, request, f"/maps/{map_name}/nodes/{node_id}")


@router.get("/api/maps/{map_name}/nodes/{node_id:int}/thumbnail", response_class=Response, responses=JPEG)
async def show_thumbnail(request: Request, map_name: MapPath, node_id: int, gateway: GatewayDep) -> Response:
    """What a place looks like."""
    return await forward(gateway, request, f"/maps/{map_name}/nodes/{node_id}/thumbnail")


@router.get("/api/maps/{map_name}/nodes/{node_id:int}/keypoints")
async def show_keypoints(request: Request, map_name: MapPath, node_id: int, gateway: GatewayDep) -> Response:
    """Where the features of a place are, and how strong."""
    return await forward(gateway, request, f"/maps/{map_name}/nodes/{node_id}/keypoints")


@router.get("/api/maps/{map_name}/edges")
async def list_edges(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """Connections of a map with their evidence."""
    return await forward(gateway, request, f"/maps/{map_name}/edges")


@router.delete("/api/maps/{map_name}/edges/{a:int}/{b:int}")
async def delete_edge(request: Request, map_name: MapPath, a: int, b: int, gateway: GatewayDep) -> Response:
    """Delete a connection."""
    return await forward(gateway, request, f"/maps/{map_name}/edges/{a}/{b}")


@router.get("/api/maps/{map_name}/revisions")
async def list_revisions(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """How a map came to be."""
    return await forward(gateway, request, f"/maps/{map_name}/revisions")


@router.get("/api/maps/{map_name}/compare")
async def compare_revisions(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """What changed between two revisions, `?from=3&to=9`; `to` is the newest when left out."""
    return await forward(gateway, request, f"/maps/{map_name}/compare")


@router.post("/api/maps/{map_name}/undo")
async def undo(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """Take a map's newest change back."""
    return await _with_body(gateway, request, f"/maps/{map_name}/undo")


@router.get("/api/maps/{map_name}/export", response_class=Response, responses=ZIP)
async def export_map(request: Request, map_name: MapPath, gateway: GatewayDep) -> Response:
    """A map as one archive."""
    return await forward(gateway, request, f"/maps/{map_name}/export")


async def _with_body(gateway: Gateway, request: Request, path: str) -> Response:
    body = await read_body(request, MAX_JSON_BYTES, gateway.settings.upload_timeout_s)
    return await forward(gateway, request, path, body)
