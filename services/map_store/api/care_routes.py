"""REST: looking for damage, and mending it."""

from collections.abc import Sequence

from fastapi import APIRouter
from fastapi.params import Depends

from services.map_store.api.names import AUTHOR, Author, MapName
from services.map_store.api.schemas import CheckView
from services.map_store.integrity.check import check
from services.map_store.integrity.repair import Repaired
from services.map_store.store import MapStore


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes /check, /maps/{map}/check and /maps/{map}/repair; `write` guards the last."""
    router = APIRouter(tags=["care"])

    @router.get("/check")
    def check_all() -> CheckView:
        """Read everything there is and list what is damaged; takes as long as reading the whole database."""
        return CheckView(damage=check(store.database))

    @router.get("/maps/{map}/check")
    def check_map(name: MapName) -> CheckView:
        """List what is damaged in one map, and in the file that all maps share."""
        return CheckView(damage=check(store.database, name))

    @router.post("/maps/{map}/repair", dependencies=write)
    def repair_map(name: MapName, author: Author = AUTHOR) -> Repaired:
        """Mend a map from its history; what is lost there too is removed, as a new revision."""
        return store.repair(name, author)

    return router
