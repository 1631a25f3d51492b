"""Signs are part of the map: written, undone, exported and compared with it; REST finds and forgets them."""

import pytest
from fastapi.testclient import TestClient

from services.map_store.errors import MissingError
from services.map_store.integrity.check import check
from services.map_store.store import MapStore
from shared.messages.maps import DeleteNode
from shared.messages.places import DeleteSign, PutSign, Sighting, Sign
from tests.unit.services.map_store.conftest import Told, app_of


def sign(name: str, *nodes: int) -> Sign:
    sightings = [Sighting(node=n, bearing_rad=0.5, height_rad=0.1, confidence=0.99) for n in nodes]
    return Sign(name=name, sightings=tuple(sightings))


ROOM, LAB = sign("214", 2, 1), sign("Lab B", 0)


@pytest.fixture
def read(client: TestClient, store: MapStore) -> TestClient:
    """REST over a map of three nodes in a row and two signs."""
    store.transact("flat", [PutSign(sign=ROOM), PutSign(sign=LAB)], author="signs")
    return client


def signs_of(store: MapStore, name: str = "flat") -> tuple[Sign, ...]:
    return store.graph(name)[1].marks.signs


def test_signs_are_told_to_followers_and_are_there_when_the_database_is_opened_again(
    read: TestClient, store: MapStore, told: Told
):
    assert told[-1].operations == (PutSign(sign=ROOM), PutSign(sign=LAB))
    assert signs_of(MapStore(store.database, lambda: 1, lambda _: None)) == (ROOM, LAB)
    assert read.get("/maps/flat/revisions").json()[0]["summary"] == "2 signs read"


@pytest.mark.usefixtures("read")
def test_undo_takes_them_back_and_a_deleted_node_leaves_until_it_is_undone(store: MapStore):
    store.transact("flat", [DeleteNode(node_id=2)])
    assert signs_of(store) == (sign("214", 1), LAB)
    store.transact("flat", [DeleteSign(name="lab b")])
    store.undo("flat")
    store.undo("flat")
    assert signs_of(store) == (ROOM, LAB)
    store.undo("flat")
    assert signs_of(store) == ()
    assert check(store.database) == []


def test_an_exported_map_is_imported_with_its_signs(read: TestClient, store: MapStore):
    archive = read.get("/maps/flat/export").content
    assert read.post("/maps/import?name=copy", content=archive).status_code == 201
    assert signs_of(store, "copy") == (ROOM, LAB)


def test_rest_lists_finds_and_forgets_signs(read: TestClient):
    assert [one["name"] for one in read.get("/maps/flat/signs").json()] == ["214", "Lab B"]
    assert [one["name"] for one in read.get("/maps/flat/signs?search=lab").json()] == ["Lab B"]
    found = read.get("/maps/flat/sign", params={"name": "room 214"}).json()
    assert [one["node"] for one in found["sightings"]] == [2, 1]
    missing = read.get("/maps/flat/sign", params={"name": "241"})
    assert (missing.status_code, "nearest: '214'" in missing.json()["detail"]) == (404, True)
    assert read.delete("/maps/flat/signs", params={"name": "214"}).status_code == 200
    assert read.delete("/maps/flat/signs", params={"name": "214"}).status_code == 404
    compared = read.get("/maps/flat/compare?from=2").json()
    assert compared["signs_added"] == ["Lab B"]


@pytest.mark.usefixtures("read")
def test_a_sign_at_a_node_that_is_not_there_is_refused(store: MapStore):
    with pytest.raises(MissingError, match="'x': node 9 does not exist"):
        store.transact("flat", [PutSign(sign=sign("x", 9))])


def test_forgetting_needs_the_token(store: MapStore):
    client = TestClient(app_of(store, token="secret"))
    assert client.delete("/maps/flat/signs", params={"name": "x"}).status_code == 401
