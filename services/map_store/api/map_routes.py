"""REST: list, make, rename and delete maps."""

from collections.abc import Sequence

from fastapi import APIRouter, Response
from fastapi.params import Depends

from services.map_store.api.names import MapName
from services.map_store.api.schemas import MapView, NewMapName, map_view
from services.map_store.store import MapStore


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes below /maps; `write` guards those that change something."""
    router = APIRouter(prefix="/maps", tags=["maps"])

    @router.get("")
    def list_maps() -> list[MapView]:
        """All maps."""
        return [map_view(summary) for summary in store.summaries()]

    @router.post("", status_code=201, dependencies=write)
    def create_map(new: NewMapName, response: Response) -> MapView:
        """Make an empty map."""
        store.create(new.name)
        response.headers["Location"] = f"/maps/{new.name}"
        return map_view(store.summary(new.name))

    @router.get("/{map}")
    def read_map(name: MapName) -> MapView:
        """One map."""
        return map_view(store.summary(name))

    @router.patch("/{map}", dependencies=write)
    def rename_map(name: MapName, new: NewMapName) -> MapView:
        """Give the map another name."""
        store.rename(name, new.name)
        return map_view(store.summary(new.name))

    @router.delete("/{map}", status_code=204, dependencies=write)
    def delete_map(name: MapName) -> None:
        """Delete the map with its history; export it first if in doubt."""
        store.delete(name)

    return router
