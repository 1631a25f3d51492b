"""REST: list, make, rename, delete and undo maps."""

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query, Response
from fastapi.params import Depends

from services.map_store.names import MapName
from services.map_store.schemas import (
    MapCreate,
    MapRename,
    MapView,
    RevisionView,
    Undone,
    map_view,
    revision_view,
)
from services.map_store.store import MapStore

AUTHOR = "rest"


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes below /maps; `write` guards those that change something."""
    router = APIRouter(prefix="/maps", tags=["maps"])

    @router.get("")
    def list_maps() -> list[MapView]:
        """All maps."""
        return [map_view(summary) for summary in store.summaries()]

    @router.post("", status_code=201, dependencies=write)
    def create_map(new: MapCreate, response: Response) -> MapView:
        """Make an empty map."""
        store.create(new.name)
        response.headers["Location"] = f"/maps/{new.name}"
        return map_view(store.summary(new.name))

    @router.get("/{map}")
    def read_map(name: MapName) -> MapView:
        """One map."""
        return map_view(store.summary(name))

    @router.patch("/{map}", dependencies=write)
    def rename_map(name: MapName, new: MapRename) -> MapView:
        """Give the map another name."""
        store.rename(name, new.name)
        return map_view(store.summary(new.name))

    @router.delete("/{map}", status_code=204, dependencies=write)
    def delete_map(name: MapName) -> None:
        """Delete the map with its history; export it first if in doubt."""
        store.delete(name)

    @router.get("/{map}/revisions")
    def list_revisions(
        name: MapName,
        before: Annotated[int, Query(ge=0, lt=2**63)] = 2**63 - 1,
        limit: Annotated[int, Query(ge=1, le=1000)] = 100,
    ) -> list[RevisionView]:
        """The history, newest first."""
        return [revision_view(revision) for revision in store.revisions(name, before, limit)]

    @router.post("/{map}/undo", dependencies=write)
    def undo(name: MapName, base_revision: Annotated[int | None, Query(ge=0, lt=2**63)] = None) -> Undone:
        """Take back the newest revision that still stands, as a new revision.

        With `base_revision` only if the map is still at that revision.
        """
        revision, undone = store.undo(name, AUTHOR, base_revision)
        return Undone(map=name, revision=revision, undone=undone)

    return router
