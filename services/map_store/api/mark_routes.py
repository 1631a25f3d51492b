"""REST: places by name, and the rules that people set on a map."""

from collections.abc import Sequence
from typing import Annotated, TypeVar

from fastapi import APIRouter, Body, Query
from fastapi.params import Depends
from pydantic import ConfigDict, Field

from services.map_store.api.names import AUTHOR, Author, MapName
from services.map_store.api.schemas import Changed
from services.map_store.errors import ConflictError, InvalidError, MissingError
from services.map_store.storage.graph import Graph
from services.map_store.store import MapStore
from shared.mapgraph.graph import edge_key
from shared.mapgraph.marks import search, users_of
from shared.messages.places import (
    DeletePlace,
    DeleteRule,
    EdgeRule,
    KeepOut,
    Mark,
    NodeIds,
    OneWay,
    OpeningHours,
    Place,
    PlaceName,
    PutPlace,
    PutRule,
    Rule,
    Slow,
    key_of,
)
from shared.wall_clock import zone_called

TRIES = 10
"""Of giving a name other nodes while a robot writes to the same map; as many as a robot has."""
M = TypeVar("M", bound=Mark)
STRICT = ConfigDict(extra="forbid")

Name = Annotated[PlaceName, Query(description="name of the place or rule")]
Search = Annotated[
    str, Query(max_length=64, description="names that hold this come first, then names like it")
]


class NewPlace(Place):
    """A name for one node, or for several: an area. The first node is the one to drive to."""

    model_config = STRICT

    nodes: Annotated[NodeIds, Field(min_length=1)]


class NewKeepOut(KeepOut):
    """Nodes, and areas by their names, that no robot may go to or through."""

    model_config = STRICT


class NewOneWay(OneWay):
    """Edges that are driven from their first node to their second only."""

    model_config = STRICT


class NewSlow(Slow):
    """Edges that are driven slowly."""

    model_config = STRICT


class NewOpeningHours(OpeningHours):
    """Edges, such as a door, that are there at some hours only."""

    model_config = STRICT


NewRule = Annotated[NewKeepOut | NewOneWay | NewSlow | NewOpeningHours, Body(discriminator="kind")]


def build(store: MapStore, write: Sequence[Depends]) -> APIRouter:
    """Routes /maps/{map}/places and /rules; `write` guards those that change something."""
    router = APIRouter(prefix="/maps/{map}", tags=["places and rules"])
    _add_rules(router, store, write)

    @router.get("/places")
    def list_places(name: MapName, search: Search = "") -> list[Place]:
        """Named places and areas by name, or those whose name is searched for."""
        return _found(search, list(store.graph(name)[1].marks.places))

    @router.put("/places", dependencies=write)
    def put_place(name: MapName, place: NewPlace, author: Author = AUTHOR) -> Changed:
        """Name nodes, or give a name other nodes, as a new revision.

        An area that a rule is about is changed with the rule: lift it first.
        """
        for left in reversed(range(TRIES)):
            revision, graph = store.graph(name)
            if users := users_of(key_of(place.name), graph.rules.values()):
                raise ConflictError(
                    f"place {place.name!r} is what rule {users[0]!r} is about; lift that first"
                )
            try:
                made = store.transact(
                    name, [PutPlace.model_validate({"place": place.model_dump()})], author, revision
                )
                return Changed(map=name, revision=made)
            except ConflictError:
                if not left or store.graph(name)[0] == revision:
                    raise
        raise AssertionError("the last try returns or raises")

    @router.delete("/places", dependencies=write)
    def delete_place(map_name: MapName, name: Name, author: Author = AUTHOR) -> Changed:
        """Forget a name, as a new revision; its nodes stay."""
        return Changed(map=map_name, revision=store.transact(map_name, [DeletePlace(name=name)], author))

    return router


def _add_rules(router: APIRouter, store: MapStore, write: Sequence[Depends]) -> None:
    @router.get("/rules")
    def list_rules(name: MapName, search: Search = "") -> list[Rule]:
        """Rules by name, or those whose name is searched for."""
        return _found(search, list(store.graph(name)[1].marks.rules))

    @router.put("/rules", dependencies=write)
    def put_rule(name: MapName, rule: NewRule, author: Author = AUTHOR) -> Changed:
        """Add a rule or replace the one of the same name, as a new revision; robots obey it at once."""
        _check_rule(rule, name, store.graph(name)[1])
        operation = PutRule.model_validate({"rule": rule.model_dump()})
        return Changed(map=name, revision=store.transact(name, [operation], author))

    @router.delete("/rules", dependencies=write)
    def delete_rule(map_name: MapName, name: Name, author: Author = AUTHOR) -> Changed:
        """Lift a rule, as a new revision."""
        return Changed(map=map_name, revision=store.transact(map_name, [DeleteRule(name=name)], author))


def _found(text: str, marks: list[M]) -> list[M]:
    return search(text, marks) if text else marks


def _check_rule(rule: Rule, name: str, graph: Graph) -> None:
    """What would be a rule about nothing, or about what is not there, is most likely mistyped."""
    if isinstance(rule, KeepOut):
        if not rule.nodes and not rule.areas:
            raise InvalidError(f"rule {rule.name!r}: nodes or areas expected, got neither")
        return
    assert isinstance(rule, EdgeRule)
    if not rule.edges:
        raise InvalidError(f"rule {rule.name!r}: at least one edge expected, got none")
    for a, b in rule.edges:
        if edge_key(a, b) not in graph.edges:
            raise MissingError(f"map {name!r}, rule {rule.name!r}: edge {a}-{b} does not exist")
    if isinstance(rule, OpeningHours) and zone_called(rule.time_zone) is None:
        expected = "the name of a time zone as IANA has it, such as Europe/Berlin"
        raise InvalidError(f"rule {rule.name!r}: {expected} expected, got {rule.time_zone!r}")
