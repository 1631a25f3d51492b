"""A write that is asked for again is answered again and not done again, also after a restart."""

import pytest
from sqlalchemy import func, select, text

from services.map_store.errors import ConflictError, MissingError
from services.map_store.integrity.check import check
from services.map_store.storage import answers
from services.map_store.storage.database import Database
from services.map_store.storage.tables import answers as table
from services.map_store.store import MapStore
from shared.messages.maps import DeleteNode, Edge, PutEdge
from tests.unit.services.map_store.conftest import Told, add

DRIVEN = PutEdge(edge=Edge(a=0, b=1, traversals=1))


@pytest.fixture
def pair(store: MapStore, told: Told) -> MapStore:
    """A map of two places."""
    store.transact("flat", [add(0), add(1)])
    told.clear()
    return store


def test_the_same_request_is_done_once_and_told_once(pair: MapStore, told: Told):
    assert [pair.transact("flat", [DRIVEN], request_id="q-1") for _ in range(3)] == [2, 2, 2]
    assert [delta.revision for delta in told] == [2]
    assert pair.transact("flat", [DRIVEN], request_id="q-2") == 3
    assert pair.transact("flat", [DRIVEN], request_id="q-1") == 2
    assert pair.summary("flat").revision == 3


def test_requests_without_an_id_are_all_done(pair: MapStore):
    assert [pair.transact("flat", [DRIVEN]) for _ in range(2)] == [2, 3]


def test_a_request_is_known_although_the_map_moved_on_or_went(pair: MapStore):
    assert pair.transact("flat", [add(2)], base_revision=1, request_id="q-1") == 2
    pair.transact("flat", [DeleteNode(node_id=2)])
    assert pair.transact("flat", [add(2)], base_revision=1, request_id="q-1") == 2
    pair.delete("flat")
    assert pair.transact("flat", [add(2)], base_revision=1, request_id="q-1") == 2


def test_a_map_is_made_once_by_one_request(store: MapStore, told: Told):
    assert [store.create("loft", "q-1") for _ in range(2)] == [0, 0]
    assert len(told) == 1
    with pytest.raises(ConflictError, match="map 'loft' exists already"):
        store.create("loft", "q-2")


def test_what_was_refused_is_tried_again(store: MapStore):
    with pytest.raises(MissingError):
        store.transact("loft", [add(0)], request_id="q-1")
    store.create("loft")
    assert store.transact("loft", [add(0)], request_id="q-1") == 1


def test_one_id_for_two_maps_is_two_requests(store: MapStore):
    store.create("loft")
    assert [store.transact(name, [add(0)], request_id="q-1") for name in ("flat", "loft")] == [1, 1]
    assert store.summary("loft").node_count == 1


def test_it_is_known_after_a_restart(pair: MapStore, database_url: str):
    pair.transact("flat", [DRIVEN], request_id="q-1")
    pair.database.close()
    again = Database(database_url)
    assert MapStore(again, lambda: 0, lambda _: None).transact("flat", [DRIVEN], request_id="q-1") == 2
    again.close()


def test_only_the_newest_are_kept(pair: MapStore, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(answers, "KEPT", 5)
    monkeypatch.setattr(answers, "FORGOTTEN", 4)
    for number in range(12):
        pair.transact("flat", [DRIVEN], request_id=f"q-{number}")
    with pair.database.read() as connection:
        assert connection.execute(select(func.count()).select_from(table)).scalar_one() == 5
    assert pair.transact("flat", [DRIVEN], request_id="q-11") == 13
    assert pair.transact("flat", [DRIVEN], request_id="q-3") == 14


def test_a_damaged_answer_is_found_never_given_and_removed_by_a_repair(pair: MapStore):
    pair.transact("flat", [DRIVEN], request_id="q-1")
    with pair.database.write() as connection:
        connection.execute(text("UPDATE answers SET revision = 9"))
    assert [(each.map, each.thing) for each in check(pair.database)] == [("", "answer 1")]
    assert pair.transact("flat", [DRIVEN], request_id="q-1") == 3
    assert check(pair.database) == []
    with pair.database.write() as connection:
        connection.execute(text("UPDATE answers SET revision = 9"))
    assert pair.repair("flat").done == ("1 answers to requests removed",)
    assert check(pair.database) == []
