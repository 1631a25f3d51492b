"""REST: what was done to a map, what that changed, and taking it back."""

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.params import Depends

from services.map_store.api.names import AUTHOR, Author, MapName
from services.map_store.api.schemas import ComparisonView, Undone, comparison_view
from services.map_store.history.revisions import Revision
from services.map_store.store import MapStore

MAX_REVISION = 2**63 - 1
"""What a database integer holds."""

RevisionNumber = Annotated[int, Query(ge=0, le=MAX_REVISION)]
Start = Annotated[int, Query(alias="from", ge=0, le=MAX_REVISION, description="revision to compare from")]
End = Annotated[int | None, Query(alias="to", ge=0, le=MAX_REVISION, description="revision to compare to")]
Limit = Annotated[int, Query(ge=1, le=1000)]  # what the console shows is a hundred


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes /maps/{map}/revisions, /compare and /undo; `write` guards the one that changes something."""
    router = APIRouter(prefix="/maps/{map}", tags=["history"])

    @router.get("/revisions")
    def list_revisions(
        name: MapName, before: RevisionNumber = MAX_REVISION, limit: Limit = 100
    ) -> list[Revision]:
        """The history, newest first."""
        return store.revisions(name, before, limit)

    @router.get("/compare")
    def compare_revisions(name: MapName, start: Start, end: End = None) -> ComparisonView:
        """What leads from one revision to another, by default to the newest; either may be the older."""
        end, comparison = store.compare(name, start, end)
        return comparison_view(name, start, end, comparison)

    @router.post("/undo", dependencies=write)
    def undo(name: MapName, base_revision: RevisionNumber | None = None, author: Author = AUTHOR) -> Undone:
        """Take back the newest revision that still stands, as a new revision.

        With `base_revision` only if the map is still at that revision.
        """
        revision, undone = store.undo(name, author, base_revision)
        return Undone(map=name, revision=revision, undone=undone)

    return router
