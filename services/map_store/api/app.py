"""REST over the same store: `create_app(store)`. The schema is at /openapi.json, a page at /docs."""

from collections.abc import Callable, Collection

from fastapi import APIRouter, Depends, FastAPI

from services.map_store.api import (
    archive_routes,
    care_routes,
    graph_routes,
    history_routes,
    map_routes,
    mark_routes,
    merge_routes,
    problems,
    taught_routes,
)
from services.map_store.api.guard import reader_guard, writer_guard
from services.map_store.api.schemas import Health
from services.map_store.errors import UnavailableError
from services.map_store.inspections import routes as inspection_routes
from services.map_store.inspections.store import InspectionStore
from services.map_store.merging.merges import Merges
from services.map_store.signs import routes as sign_routes
from services.map_store.store import MapStore
from shared.web.bodies import BodyLimit, BodyLimits

VERSION = "1"
MAX_BODY_BYTES = 100_000
"""Of every request but an import: an area of all the nodes it may have."""
STALLED_S = 30.0
"""The gateway ends stalled senders earlier; this is for those that come here directly."""
LEAST_BYTES_PER_S = 1.0
"""None worth the name: a body that flows may take its time."""

DESCRIPTION = "Topological maps: their nodes, edges, pictures and history. Errors are RFC 9457 problems."


def create_app(
    store: MapStore,
    merges: Merges,
    visits: InspectionStore,
    token: str = "",
    max_archive_bytes: int = 4_000_000_000,
    ready: Callable[[], bool] = lambda: True,
    names: Collection[str] | None = None,
    guard_reading: bool = False,
) -> FastAPI:
    """Build the application.

    Args:
        store: the maps.
        merges: those under way, and how the last ones ended.
        visits: what inspections saw.
        token: bearer token that writes need; empty = none.
        max_archive_bytes: largest archive to import.
        ready: whether the bus side answers too.
        names: what Host may say; None = anything.
        guard_reading: reading needs the token as well.
    """
    app = FastAPI(title="topnav map store", version=VERSION, description=DESCRIPTION)
    short, long = (
        BodyLimit(most, STALLED_S, LEAST_BYTES_PER_S, "send less")
        for most in (MAX_BODY_BYTES, max_archive_bytes)
    )
    app.add_middleware(BodyLimits, most=short, exceptions={"/maps/import": long})
    problems.install(app)
    write = [Depends(writer_guard(token))]
    read = [Depends(reader_guard(token if guard_reading else "", names))]
    for router in (
        map_routes.build(store, write),
        history_routes.build(store, write),
        graph_routes.build(store, write),
        mark_routes.build(store, write),
        taught_routes.build(store, write),
        sign_routes.build(store, write),
        care_routes.build(store, write),
        archive_routes.build(store, write, max_archive_bytes),
        merge_routes.build(store, merges, write),
        inspection_routes.build(visits),
    ):
        app.include_router(router, dependencies=read)
    app.include_router(_health(store, ready))
    return app


def _health(store: MapStore, ready: Callable[[], bool]) -> APIRouter:
    router = APIRouter(tags=["health"])

    @router.get("/healthz")
    def healthz() -> Health:
        """The process lives."""
        return Health(status="alive")

    @router.get("/readyz")
    def readyz() -> Health:
        """The database answers and questions on the bus are taken."""
        if not ready():
            raise UnavailableError("the bus side has not started")
        store.summaries()
        return Health(status="ready")

    return router
