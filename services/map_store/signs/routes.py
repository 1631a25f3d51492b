"""REST: signs that were read in a map, and from which nodes."""

from collections.abc import Sequence
from typing import Annotated

from fastapi import APIRouter, Query
from fastapi.params import Depends

from services.map_store.api.names import AUTHOR, Author, MapName
from services.map_store.api.schemas import Changed
from services.map_store.errors import MissingError
from services.map_store.store import MapStore
from shared.mapgraph.marks import search, sign_called
from shared.messages.places import DeleteSign, PlaceName, Sign

Text = Annotated[PlaceName, Query(description="what the sign says")]
Search = Annotated[
    str, Query(max_length=64, description="signs that hold this come first, then those that are like it")
]


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes /maps/{map}/signs and /sign; `write` guards the one that changes something."""
    router = APIRouter(prefix="/maps/{map}", tags=["signs"])

    @router.get("/signs")
    def list_signs(name: MapName, search_for: Annotated[Search, Query(alias="search")] = "") -> list[Sign]:
        """Signs by what they say, or those that are searched for; of each the best node comes first."""
        signs = list(store.graph(name)[1].marks.signs)
        return search(search_for, signs) if search_for else signs

    @router.get("/sign")
    def show_sign(map_name: MapName, name: Text) -> Sign:
        """One sign; 404 tells those that say nearly the same."""
        sign = sign_called(name, store.graph(map_name)[1].signs)
        if isinstance(sign, str):
            raise MissingError(f"map {map_name!r}: {sign}")
        return sign

    @router.delete("/signs", dependencies=write)
    def delete_sign(map_name: MapName, name: Text, author: Author = AUTHOR) -> Changed:
        """Forget a sign, as a new revision: one that was misread."""
        return Changed(map=map_name, revision=store.transact(map_name, [DeleteSign(name=name)], author))

    return router
