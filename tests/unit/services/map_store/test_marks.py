"""Places and rules are part of the map: written, undone, exported, checked and mended with it."""

import json
from typing import Any

import pytest
from fastapi.testclient import TestClient
from sqlalchemy import delete, update

from services.map_store.errors import ConflictError, CorruptError, InvalidError, MissingError
from services.map_store.integrity.check import check
from services.map_store.storage.tables import marks
from services.map_store.store import MapStore
from shared.mapgraph import mark_draft
from shared.messages.maps import DeleteNode
from shared.messages.places import (
    DeletePlace,
    DeleteRule,
    KeepOut,
    Marks,
    OneWay,
    OpeningHours,
    Place,
    PutPlace,
    PutRule,
    Slow,
)
from tests.unit.services.map_store.conftest import Told, app_of

KITCHEN = Place(name="Kitchen", nodes=(2, 0))
LAB = Place(name="Lab", nodes=(1,))
SHUT = KeepOut(name="no robots", nodes=(0,), areas=("Lab",))
LANE = OneWay(name="lane", edges=((1, 0),))
NIGHT = OpeningHours(name="night", edges=((1, 2),), time_zone="Europe/Berlin")
ALL = [*(PutPlace(place=place) for place in (KITCHEN, LAB)), *(PutRule(rule=r) for r in (SHUT, LANE, NIGHT))]
MARKS = Marks(places=(KITCHEN, LAB), rules=(LANE, NIGHT, SHUT))


@pytest.fixture
def marked(client: TestClient, store: MapStore) -> TestClient:
    """REST over a map of three nodes, two edges, two places and three rules."""
    store.transact("flat", ALL, author="anna")
    return client


def marks_of(store: MapStore, name: str = "flat") -> Marks:
    return store.graph(name)[1].marks


def test_they_are_told_to_followers_and_are_there_when_the_database_is_opened_again(
    marked: TestClient, store: MapStore, told: Told
):
    assert told[-1].operations == tuple(ALL)
    assert not told[-1].reset
    again = MapStore(store.database, lambda: 1, lambda _: None)
    assert marks_of(again) == MARKS
    assert marked.get("/maps/flat/revisions").json()[0]["summary"] == "2 places named, 3 rules put"


@pytest.mark.usefixtures("marked")
def test_undo_takes_them_back_one_revision_after_the_other(store: MapStore):
    store.transact("flat", [PutPlace(place=Place(name="kitchen", nodes=(1,)))])
    store.transact("flat", [DeleteRule(name="No Robots")])
    store.undo("flat")
    assert marks_of(store).rules == MARKS.rules
    store.undo("flat")
    assert marks_of(store) == MARKS
    store.undo("flat")
    assert marks_of(store) == Marks()
    assert check(store.database) == []


@pytest.mark.usefixtures("marked")
def test_a_node_that_is_deleted_leaves_them_and_an_undo_brings_it_back_in_its_place(store: MapStore):
    store.transact("flat", [DeleteNode(node_id=0)])
    assert marks_of(store) == Marks(
        places=(Place(name="Kitchen", nodes=(2,)), LAB),
        rules=(OneWay(name="lane"), NIGHT, KeepOut(name="no robots", areas=("Lab",))),
    )
    store.undo("flat")
    assert marks_of(store) == MARKS


def test_an_exported_map_is_imported_with_them(marked: TestClient, store: MapStore):
    archive = marked.get("/maps/flat/export").content
    assert marked.post("/maps/import?name=copy", content=archive).status_code == 201
    assert marks_of(store, "copy") == MARKS
    assert marked.get("/maps/flat/export").content == archive


@pytest.mark.usefixtures("marked")
def test_renaming_and_deleting_a_map_keeps_and_takes_them(store: MapStore):
    store.rename("flat", "house")
    assert marks_of(store, "house") == MARKS
    store.delete("house")
    store.create("house")
    assert marks_of(store, "house") == Marks()


@pytest.mark.parametrize("lost", [False, True])
@pytest.mark.usefixtures("marked")
def test_a_damaged_record_of_them_is_found_and_written_anew_from_the_history(store: MapStore, lost: bool):
    change = delete(marks) if lost else update(marks).values(record=Marks().model_dump_json())
    with store.database.write() as connection:
        connection.execute(change.where(marks.c.map_id == store.summary("flat").map_id))
    again = MapStore(store.database, lambda: 1, lambda _: None)
    with pytest.raises(CorruptError, match=r"places and rules: their record .*topnav map repair flat"):
        again.graph("flat")
    assert [(each.map, each.thing) for each in check(store.database)] == [("flat", "places and rules")]
    assert again.repair("flat").done == ("places and rules: written anew from the history",)
    assert marks_of(again) == MARKS
    assert check(store.database) == []


REFUSED = [
    (PutPlace(place=Place(name="far", nodes=(0, 9))), MissingError, "'far': node 9 does not exist"),
    (DeletePlace(name="Kichen"), MissingError, "no place 'Kichen'; nearest: 'Kitchen'"),
    (DeletePlace(name="lab"), ConflictError, "what rule 'no robots' is about; lift that first"),
    (PutRule(rule=KeepOut(name="x", areas=("Lap",))), MissingError, "no place 'Lap'; nearest: 'Lab'"),
    (PutRule(rule=Slow(name="x", edges=((0, 7),))), MissingError, "'x': node 7 does not exist"),
    (DeleteRule(name="lanes"), MissingError, "no rule 'lanes'; nearest: 'lane'"),
]


@pytest.mark.parametrize(("operation", "kind", "words"), REFUSED)
@pytest.mark.usefixtures("marked")
def test_what_does_not_fit_is_refused_with_the_nearest_names_and_changes_nothing(
    store: MapStore, operation: Any, kind: type[Exception], words: str
):
    before = store.graph("flat")[0]
    with pytest.raises(kind, match=words):
        store.transact("flat", [operation])
    assert (store.graph("flat")[0], marks_of(store)) == (before, MARKS)


@pytest.mark.usefixtures("marked")
def test_there_is_an_end_to_how_many_a_map_holds(store: MapStore, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(mark_draft, "MARKS_MAX", 3)
    store.transact("flat", [PutPlace(place=Place(name="one more", nodes=(0,)))])
    with pytest.raises(InvalidError, match="at most 3 places"):
        store.transact("flat", [PutPlace(place=Place(name="too many", nodes=(0,)))])
    monkeypatch.setattr(mark_draft, "MENTIONS_MAX", 9)
    with pytest.raises(InvalidError, match="list at most 9 nodes"):
        store.transact("flat", [PutPlace(place=Place(name="one more", nodes=(0, 1, 2)))])


def test_rest_names_lists_finds_and_forgets_places(client: TestClient, store: MapStore):
    put = client.put("/maps/flat/places", json={"name": "  Küche \u00a0 2 ", "nodes": [1]})
    assert put.json() == {"map": "flat", "revision": 3}
    client.put("/maps/flat/places", json={"name": "Bad", "nodes": [0]}, headers={"X-Topnav-Author": "anna"})
    assert client.get("/maps/flat/places").json() == [
        {"name": "Bad", "nodes": [0]},
        {"name": "Küche 2", "nodes": [1]},
    ]
    assert [p["name"] for p in client.get("/maps/flat/places?search=KÜCHE").json()] == ["Küche 2"]
    assert [p["name"] for p in client.get("/maps/flat/places?search=kuche 2").json()] == ["Küche 2"]
    assert client.delete("/maps/flat/places", params={"name": "küche 2"}).status_code == 200
    assert client.delete("/maps/flat/places", params={"name": "küche 2"}).status_code == 404
    assert [place.name for place in marks_of(store).places] == ["Bad"]
    history = client.get("/maps/flat/revisions").json()
    assert [(r["author"], r["summary"]) for r in history[:2]] == [
        ("rest", "place 'küche 2' forgotten"),
        ("anna", "place 'Bad' named"),
    ]
    found = client.get("/maps/flat/compare?from=3").json()
    assert (found["places_added"], found["places_removed"]) == (["Bad"], ["Küche 2"])


def test_rest_sets_rules_lists_them_and_lifts_them(client: TestClient):
    rules = [
        {"kind": "keep_out", "name": "shut", "nodes": [0], "areas": []},
        {"kind": "slow", "name": "ramp", "edges": [[1, 0]], "speed_share": 0.3},
        {
            "kind": "opening_hours",
            "name": "door",
            "edges": [[1, 2]],
            "hours": [{"days": ["mon"], "opens": "08:00", "closes": "18:00"}],
            "time_zone": "Europe/Berlin",
        },
    ]
    for rule in rules:
        assert client.put("/maps/flat/rules", json=rule).status_code == 200
    assert client.get("/maps/flat/rules").json() == [rules[2], rules[1], rules[0]]
    assert client.delete("/maps/flat/rules", params={"name": "shut"}).status_code == 200
    assert [rule["name"] for rule in client.get("/maps/flat/rules").json()] == ["door", "ramp"]


def test_an_area_that_a_rule_is_about_gets_no_other_nodes_over_rest(marked: TestClient, store: MapStore):
    """Who may name places may not lift rules, and would by that."""
    answer = marked.put("/maps/flat/places", json={"name": "LAB", "nodes": [2]})
    assert (answer.status_code, marks_of(store)) == (409, MARKS)
    assert "what rule 'no robots' is about" in answer.json()["detail"]


HOSTILE = ["", " ", "a\nb", "\x1b[31mred", "a\u202eb", "a\u200bb", "x" * 65, "\ud800"]
EARLY = {"opens": "8", "closes": "9"}
BAD_BODIES = [
    ("places", {"name": "x"}),
    ("places", {"name": "x", "nodes": []}),
    ("places", {"name": "x", "nodes": [-1]}),
    ("places", {"name": "x", "nodes": [0], "note": "y"}),
    ("rules", {"kind": "keep_out", "name": "x"}),
    ("rules", {"kind": "slow", "name": "x", "edges": []}),
    ("rules", {"kind": "slow", "name": "x", "edges": [[0, 0]]}),
    ("rules", {"kind": "slow", "name": "x", "edges": [[0, 1]], "speed_share": 0}),
    ("rules", {"kind": "opening_hours", "name": "x", "edges": [[0, 1]], "time_zone": "Mars/Base"}),
    ("rules", {"kind": "opening_hours", "name": "x", "edges": [[0, 1]], "time_zone": "../../etc/passwd"}),
    ("rules", {"kind": "opening_hours", "name": "x", "edges": [[0, 1]], "hours": [EARLY]}),
    ("rules", {"kind": "closed", "name": "x"}),
    ("rules", {"kind": "one_way", "name": "x", "edges": [[0]]}),
]


@pytest.mark.parametrize("name", HOSTILE)
def test_names_that_deceive_are_refused(client: TestClient, store: MapStore, name: str):
    body = json.dumps({"name": name, "nodes": [0]})
    answer = client.put("/maps/flat/places", content=body, headers={"content-type": "application/json"})
    assert answer.status_code == 422, answer.text
    assert marks_of(store) == Marks()


@pytest.mark.parametrize(("what", "body"), BAD_BODIES)
def test_bodies_that_say_nothing_or_too_much_are_refused(
    client: TestClient, store: MapStore, what: str, body: dict[str, Any]
):
    answer = client.put(f"/maps/flat/{what}", json=body)
    assert answer.status_code == 422, answer.text
    assert marks_of(store) == Marks()


def test_a_rule_about_an_edge_that_is_not_there_is_refused(client: TestClient):
    answer = client.put("/maps/flat/rules", json={"kind": "one_way", "name": "x", "edges": [[2, 0]]})
    assert (answer.status_code, "edge 2-0 does not exist" in answer.json()["detail"]) == (404, True)


@pytest.mark.parametrize("method", ["put", "delete"])
@pytest.mark.parametrize("what", ["places", "rules"])
def test_writing_them_needs_the_token(store: MapStore, method: str, what: str):
    client = TestClient(app_of(store, token="secret"))
    answer = client.request(method, f"/maps/flat/{what}", params={"name": "x"}, json={})
    assert answer.status_code == 401
