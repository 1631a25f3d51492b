"""REST: nodes, their pictures and edges."""

from collections.abc import Sequence
from typing import Annotated, Any

from fastapi import APIRouter, Query, Response
from fastapi.params import Depends

from services.map_store.api.names import AUTHOR, Author, MapName, NodeId
from services.map_store.api.schemas import Changed, EdgeView, KeypointsView, NodeView, keypoints_view
from services.map_store.api.views import edge_views, node_views
from services.map_store.errors import CorruptError, MissingError
from services.map_store.storage.contents import node_of
from services.map_store.storage.graph import MAX_NODE_ID
from services.map_store.store import MapStore
from shared.messages.maps import DeleteEdge, DeleteNode
from shared.wire import MAX_CONTAINER

JPEG: dict[int | str, dict[str, Any]] = {200: {"content": {"image/jpeg": {}}}}
Limit = Annotated[int, Query(ge=1, le=MAX_CONTAINER)]
After = Annotated[int, Query(ge=-1, le=MAX_NODE_ID, description="last node id of the page before")]


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes below /maps/{map}/nodes and /maps/{map}/edges; `write` guards those that change something."""
    router = APIRouter(prefix="/maps/{map}", tags=["graph"])
    _add_appearance(router, store)

    @router.get("/nodes")
    def list_nodes(name: MapName, after: After = -1, limit: Limit = MAX_CONTAINER) -> list[NodeView]:
        """Nodes by number."""
        return node_views(store, name, after, limit)

    @router.get("/nodes/{node_id}")
    def read_node(name: MapName, node_id: NodeId) -> NodeView:
        """One node."""
        found = node_views(store, name, node_id - 1, 1)
        if not found or found[0].node_id != node_id:
            raise MissingError(f"map {name!r}: node {node_id} does not exist")
        return found[0]

    @router.get("/edges")
    def list_edges(name: MapName) -> list[EdgeView]:
        """Edges with their evidence."""
        return edge_views(store, name)

    @router.delete("/nodes/{node_id}", dependencies=write)
    def delete_node(name: MapName, node_id: NodeId, author: Author = AUTHOR) -> Changed:
        """Delete a node and its edges, as a new revision."""
        revision = store.transact(name, [DeleteNode(node_id=node_id)], author)
        return Changed(map=name, revision=revision)

    @router.delete("/edges/{a}/{b}", dependencies=write)
    def delete_edge(name: MapName, a: NodeId, b: NodeId, author: Author = AUTHOR) -> Changed:
        """Delete an edge, as a new revision."""
        revision = store.transact(name, [DeleteEdge(a=min(a, b), b=max(a, b))], author)
        return Changed(map=name, revision=revision)

    return router


def _add_appearance(router: APIRouter, store: MapStore) -> None:
    """Routes of what a node looks like."""

    @router.get("/nodes/{node_id}/thumbnail", response_class=Response, responses=JPEG)
    def read_thumbnail(name: MapName, node_id: NodeId) -> Response:
        """The small picture of a node."""
        _, graph = store.graph(name)
        data = store.contents.read(name, node_of(graph, name, node_id), "thumbnail")
        if not data:
            raise MissingError(f"map {name!r}: node {node_id} has no thumbnail")
        # A node's picture never changes, but another node may get its number after an undo.
        headers = {"Cache-Control": "private, no-cache", "X-Content-Type-Options": "nosniff"}
        return Response(data, media_type="image/jpeg", headers=headers)

    @router.get("/nodes/{node_id}/keypoints")
    def read_keypoints(name: MapName, node_id: NodeId) -> KeypointsView:
        """Where the features of a node are, and how strong."""
        _, found = store.contents.features(name, [node_id])
        if not found:
            where = f"map {name!r}, node {node_id}"
            raise CorruptError(f"{where}: features: damaged; delete the node or import a backup")
        return keypoints_view(found[0].features)
