"""Maps: passed through to the map store, so that a browser needs one address only."""

from collections.abc import Callable
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Path, Request
from fastapi.responses import JSONResponse, Response

from services.gateway.http.bodies import MAX_JSON_BYTES, read_body
from services.gateway.http.map_store_proxy import forward, forward_stream
from services.gateway.state import GatewayDep, MapPath, NodePath

API, IMPORT = "/api", "/maps/import"
MAP, NODE, EDGE = "/maps/{map_name}", "/nodes/{node_id}", "/edges/{a}/{b}"
ROUND = "/inspections/{round}"
OPERATIONS = (
    ("GET", "/maps", "list_maps", "All maps."),
    ("POST", "/maps", "create_map", "Make an empty map."),
    ("POST", IMPORT, "import_map", "Add a map from an archive made by export."),
    ("GET", MAP, "show_map", "One map: its counts and revision."),
    ("PATCH", MAP, "rename_map", "Rename a map."),
    ("DELETE", MAP, "delete_map", "Delete a map."),
    ("GET", f"{MAP}/nodes", "list_nodes", "Nodes of a map."),
    ("GET", MAP + NODE, "show_node", "One node."),
    ("DELETE", MAP + NODE, "delete_node", "Delete a node and its edges."),
    ("GET", f"{MAP}{NODE}/thumbnail", "show_thumbnail", "What a node looks like."),
    ("GET", f"{MAP}{NODE}/keypoints", "show_keypoints", "Where a node's features are, and how strong."),
    ("GET", f"{MAP}/edges", "list_edges", "Edges of a map with their evidence."),
    ("DELETE", MAP + EDGE, "delete_edge", "Delete an edge."),
    ("GET", f"{MAP}/places", "list_places", "Named places and areas of a map, or those `search` finds."),
    ("PUT", f"{MAP}/places", "put_place", "Name nodes: body `name` and `nodes`, the one to drive to first."),
    ("DELETE", f"{MAP}/places", "delete_place", "Forget the place `name`; its nodes stay."),
    ("GET", f"{MAP}/rules", "list_rules", "Rules of a map: keep-out, one-way, slow, opening hours."),
    ("PUT", f"{MAP}/rules", "put_rule", "Set a rule; robots obey it at once."),
    ("DELETE", f"{MAP}/rules", "delete_rule", "Lift the rule `name`."),
    ("GET", f"{MAP}/routes", "list_routes", "Routes of a map, or those that `search` finds."),
    ("GET", f"{MAP}/route", "show_route", "The route `name`: its nodes in order, and its gaps."),
    ("PUT", f"{MAP}/routes", "put_route", "Keep a route: body `name` and `nodes` in the order of driving."),
    ("DELETE", f"{MAP}/routes", "delete_route", "Forget the route `name`; its nodes stay."),
    ("GET", f"{MAP}/signs", "list_signs", "Signs read in a map, or those that `search` finds."),
    (
        "GET",
        f"{MAP}/sign",
        "show_sign",
        "The sign that says `name`: the nodes it is read from, the best first.",
    ),
    ("DELETE", f"{MAP}/signs", "delete_sign", "Forget the sign `name`."),
    ("GET", f"{MAP}/revisions", "list_revisions", "How a map came to be."),
    ("GET", f"{MAP}/compare", "compare_revisions", "Changes from revision `from` to `to`, or to now."),
    ("POST", f"{MAP}/undo", "undo", "Take a map's newest change back."),
    ("POST", f"{MAP}/merge", "start_merge", "Start adding the nodes of the map `other` to this one."),
    ("GET", f"{MAP}/merge", "show_merge", "The running or last merge into a map."),
    (
        "DELETE",
        f"{MAP}/merge",
        "cancel_merge",
        "Cancel the merge into a map, if it is not written yet.",
    ),
    ("GET", f"{MAP}/inspections", "list_inspections", "Rounds of inspections, the newest first."),
    ("GET", MAP + ROUND, "show_inspection", "One round: its places and what changed."),
    (
        "GET",
        f"{MAP}{ROUND}/report",
        "show_report",
        "One round as a page: both pictures of every place, changes marked.",
    ),
    (
        "GET",
        f"{MAP}{ROUND}/picture",
        "show_picture",
        "What `place` looked like in a round; with `before` what it was compared with.",
    ),
    ("GET", f"{MAP}/export", "export_map", "A map as one archive."),
)
STATUS = {"create_map": 201, "import_map": 201, "delete_map": 204, "start_merge": 202}
MEDIA = {
    "show_thumbnail": "image/jpeg",
    "show_report": "text/html",
    "show_picture": "image/jpeg",
    "export_map": "application/zip",
}


async def pass_on(request: Request, gateway: GatewayDep) -> Response:
    """Answer as the map store does; where it says that something is, is below our own path."""
    path = request.url.path.removeprefix(API)
    if path == IMPORT:
        return await forward_stream(gateway, request, path)
    body = b""
    if request.method in ("POST", "PUT", "PATCH"):
        body = await read_body(request, MAX_JSON_BYTES, gateway.settings.upload_timeout_s)
    answer = await forward(gateway, request, path, body)
    if "location" in answer.headers:
        answer.headers["location"] = API + answer.headers["location"]
    return answer


async def _names_a_map(map_name: MapPath) -> None:
    """What the path says, checked."""


async def _names_a_node(node_id: NodePath) -> None:
    """What the path says, checked."""


async def _names_an_edge(a: NodePath, b: NodePath) -> None:
    """What the path says, checked."""


async def _names_a_round(
    round_id: Annotated[str, Path(alias="round", pattern=r"^[A-Za-z0-9_-]{1,64}-[0-9]{1,9}$")],
) -> None:
    """What the path says, checked."""


NAMED: dict[str, Callable[..., Any]] = {
    MAP: _names_a_map,
    NODE: _names_a_node,
    EDGE: _names_an_edge,
    ROUND: _names_a_round,
}
router = APIRouter(tags=["maps"])
for _method, _path, _name, _description in OPERATIONS:
    router.add_api_route(
        API + _path,
        pass_on,
        methods=[_method],
        name=_name,
        description=_description,
        status_code=STATUS.get(_name),
        dependencies=[Depends(check) for part, check in NAMED.items() if part in _path],
        response_class=Response if _name in MEDIA else JSONResponse,
        responses={200: {"content": {MEDIA[_name]: {}}}} if _name in MEDIA else None,
    )
