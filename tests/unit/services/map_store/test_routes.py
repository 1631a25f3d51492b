"""Routes are part of the map: written, undone, exported and mended with it; a gap is told, never made."""

from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import update

from services.map_store.errors import InvalidError, MissingError
from services.map_store.integrity.check import check
from services.map_store.storage.tables import marks
from services.map_store.store import MapStore
from shared.mapgraph import mark_draft
from shared.messages.maps import DeleteEdge, DeleteNode
from shared.messages.places import DeleteRoute, Marks, PutRoute, Route
from tests.unit.services.map_store.conftest import Told, app_of

TOUR = Route(name="Tour", nodes=(0, 1, 2, 1))
PUT = PutRoute(route=TOUR)


@pytest.fixture
def taught(client: TestClient, store: MapStore) -> TestClient:
    """REST over a map of three nodes in a row and a route along them."""
    store.transact("flat", [PUT], author="anna")
    return client


def routes_of(store: MapStore, name: str = "flat") -> tuple[Route, ...]:
    return store.graph(name)[1].marks.routes


def test_a_route_is_told_to_followers_and_is_there_when_the_database_is_opened_again(
    taught: TestClient, store: MapStore, told: Told
):
    assert told[-1].operations == (PUT,)
    assert routes_of(MapStore(store.database, lambda: 1, lambda _: None)) == (TOUR,)
    assert taught.get("/maps/flat/revisions").json()[0]["summary"] == "route 'Tour' put"


@pytest.mark.usefixtures("taught")
def test_undo_takes_it_back_and_brings_it_back(store: MapStore):
    store.transact("flat", [PutRoute(route=Route(name="tour", nodes=(2, 1)))])
    store.transact("flat", [DeleteRoute(name="TOUR")])
    store.undo("flat")
    assert routes_of(store) == (Route(name="tour", nodes=(2, 1)),)
    store.undo("flat")
    assert routes_of(store) == (TOUR,)
    store.undo("flat")
    assert routes_of(store) == ()
    assert check(store.database) == []


def test_a_deleted_node_leaves_it_and_the_gap_is_told_until_an_undo_mends_it(
    taught: TestClient, store: MapStore
):
    store.transact("flat", [DeleteNode(node_id=1)])
    left = {"name": "Tour", "nodes": [0, 2], "gaps": [[0, 2]]}
    assert taught.get("/maps/flat/route", params={"name": "tour"}).json() == left
    store.transact("flat", [DeleteNode(node_id=0)])
    assert taught.get("/maps/flat/routes").json() == [{"name": "Tour", "nodes": [2], "gaps": []}]
    store.undo("flat")
    assert taught.get("/maps/flat/routes").json() == [left]
    store.undo("flat")
    assert taught.get("/maps/flat/routes").json() == [{**left, "nodes": [0, 1, 2, 1], "gaps": []}]


def test_a_deleted_edge_leaves_a_gap(taught: TestClient, store: MapStore):
    store.transact("flat", [DeleteEdge(a=1, b=2)])
    assert taught.get("/maps/flat/route", params={"name": "tour"}).json()["gaps"] == [[1, 2], [2, 1]]


def test_an_exported_map_is_imported_with_its_routes_also_with_one_that_has_a_gap(
    taught: TestClient, store: MapStore
):
    store.transact("flat", [DeleteEdge(a=1, b=2)])
    archive = taught.get("/maps/flat/export").content
    assert taught.post("/maps/import?name=copy", content=archive).status_code == 201
    assert routes_of(store, "copy") == (TOUR,)
    assert taught.get("/maps/flat/export").content == archive


@pytest.mark.usefixtures("taught")
def test_a_damaged_record_of_routes_is_written_anew_from_the_history(store: MapStore):
    with store.database.write() as connection:
        connection.execute(update(marks).values(record=Marks().model_dump_json()))
    again = MapStore(store.database, lambda: 1, lambda _: None)
    assert again.repair("flat").done == ("places and rules: written anew from the history",)
    assert routes_of(again) == (TOUR,)


@pytest.mark.parametrize(
    ("operation", "words"),
    [
        (PutRoute(route=Route(name="x", nodes=(0, 9))), "'x': node 9 does not exist"),
        (PutRoute(route=Route(name="x", nodes=(1, 0, 2))), "route 'x': edge 0-2 does not exist"),
        (PutRoute(route=Route(name="x", nodes=(0, 0))), "route 'x': edge 0-0 does not exist"),
        (DeleteRoute(name="Tuor"), "no route 'Tuor'; nearest: 'Tour'"),
    ],
)
@pytest.mark.usefixtures("taught")
def test_what_cannot_be_driven_or_is_not_there_is_refused_and_changes_nothing(
    store: MapStore, operation: Any, words: str
):
    before = store.graph("flat")[0]
    with pytest.raises(MissingError, match=words):
        store.transact("flat", [operation])
    assert (store.graph("flat")[0], routes_of(store)) == (before, (TOUR,))


@pytest.mark.usefixtures("taught")
def test_a_route_that_comes_to_a_node_again_counts_it_again(store: MapStore, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(mark_draft, "MENTIONS_MAX", 6)
    with pytest.raises(InvalidError, match="list at most 6 nodes"):
        store.transact("flat", [PutRoute(route=Route(name="y", nodes=(0, 1, 0)))])


def test_rest_keeps_lists_finds_and_forgets_routes(client: TestClient):
    for name, nodes in (("Tour", [0, 1, 2]), ("Küche", [2, 1])):
        assert client.put("/maps/flat/routes", json={"name": name, "nodes": nodes}).status_code == 200
    assert [route["name"] for route in client.get("/maps/flat/routes").json()] == ["Küche", "Tour"]
    assert [route["name"] for route in client.get("/maps/flat/routes?search=kuche").json()] == ["Küche"]
    missing = client.get("/maps/flat/route", params={"name": "Toor"})
    assert (missing.status_code, "nearest: 'Tour'" in missing.json()["detail"]) == (404, True)
    assert client.delete("/maps/flat/routes", params={"name": "tour"}).status_code == 200
    assert client.delete("/maps/flat/routes", params={"name": "tour"}).status_code == 404
    compared = client.get("/maps/flat/compare?from=2").json()
    assert (compared["routes_added"], compared["routes_removed"]) == (["Küche"], [])


@pytest.mark.parametrize(
    "body",
    [
        {"name": "x"},
        {"name": "x", "nodes": [0]},
        {"name": "a\u202eb", "nodes": [0, 1]},
        {"name": "x", "nodes": [0, 1], "loop": True},
    ],
)
def test_bodies_that_are_no_route_are_refused(client: TestClient, store: MapStore, body: dict[str, Any]):
    assert client.put("/maps/flat/routes", json=body).status_code == 422
    assert routes_of(store) == ()


@pytest.mark.parametrize("method", ["put", "delete"])
def test_writing_routes_needs_the_token(store: MapStore, method: str):
    client = TestClient(app_of(store, token="secret"))
    assert client.request(method, "/maps/flat/routes", params={"name": "x"}, json={}).status_code == 401
