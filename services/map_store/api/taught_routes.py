"""REST: routes of a map, the nodes that a robot drives to one after the other."""

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.params import Depends
from pydantic import ConfigDict, Field

from services.map_store.api.names import AUTHOR, Author, MapName
from services.map_store.api.schemas import Changed
from services.map_store.errors import MissingError
from services.map_store.storage.graph import Graph
from services.map_store.store import MapStore
from shared.mapgraph.marks import gaps, route_called, search
from shared.messages.places import DeleteRoute, NodeIds, PlaceName, PutRoute, Route

Name = Annotated[PlaceName, Query(description="name of the route")]
Search = Annotated[
    str, Query(max_length=64, description="names that hold this come first, then names like it")
]


class NewRoute(Route):
    """Nodes in the order of driving; an edge joins each to the next."""

    model_config = ConfigDict(extra="forbid")

    nodes: Annotated[NodeIds, Field(min_length=2)]


class RouteView(Route):
    """A route as it is.

    Attributes:
        gaps: pairs of nodes, one after the other, that no edge joins since something was deleted.
    """

    gaps: list[tuple[int, int]]


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes /maps/{map}/routes and /route; `write` guards those that change something."""
    router = APIRouter(prefix="/maps/{map}", tags=["routes"])

    @router.get("/routes")
    def list_routes(
        name: MapName, search_for: Annotated[Search, Query(alias="search")] = ""
    ) -> list[RouteView]:
        """Routes by name, or those whose name is searched for."""
        graph = store.graph(name)[1]
        routes = list(graph.marks.routes)
        return [_view(route, graph) for route in (search(search_for, routes) if search_for else routes)]

    @router.get("/route")
    def show_route(map_name: MapName, name: Name) -> RouteView:
        """One route."""
        graph = store.graph(map_name)[1]
        route = route_called(name, graph.routes)
        if isinstance(route, str):
            raise MissingError(f"map {map_name!r}: {route}")
        return _view(route, graph)

    @router.put("/routes", dependencies=write)
    def put_route(name: MapName, route: NewRoute, author: Author = AUTHOR) -> Changed:
        """Keep a route or replace the one of the same name, as a new revision.

        Refused where a node is not there or no edge joins one to the next.
        """
        operation = PutRoute.model_validate({"route": route.model_dump()})
        return Changed(map=name, revision=store.transact(name, [operation], author))

    @router.delete("/routes", dependencies=write)
    def delete_route(map_name: MapName, name: Name, author: Author = AUTHOR) -> Changed:
        """Forget a route, as a new revision; its nodes stay."""
        return Changed(map=map_name, revision=store.transact(map_name, [DeleteRoute(name=name)], author))

    return router


def _view(route: Route, graph: Graph) -> RouteView:
    return RouteView(name=route.name, nodes=route.nodes, gaps=gaps(route, graph.edges))
