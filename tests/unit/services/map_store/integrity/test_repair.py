"""A repair: rows come back from the history, what is lost there too goes as a revision that can be undone."""

from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from services.map_store.errors import CorruptError, GivenUpError, MissingError
from services.map_store.integrity.check import check
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from shared.messages.maps import Node, UpdateNode
from tests.unit.services.map_store.conftest import Told, add
from tests.unit.services.map_store.test_damage import FLAT, REFUSED, flip_first, tamper
from tests.unit.services.map_store.test_store import damage, graph_of, link, reopened


@pytest.fixture
def chain(store: MapStore) -> MapStore:
    """Map "flat": three nodes in a row, one updated, in three revisions."""
    store.transact("flat", [add(0), add(1), link(0, 1)], author="planner")
    store.transact("flat", [add(2), link(1, 2)], author="planner")
    changed = Node(node_id=1, stamp_ns=2, pipeline="sift", keypoints=4, open=(True,) * 12)
    store.transact("flat", [UpdateNode(node=changed)], author="planner")
    return store


@pytest.mark.parametrize("statement", [statement for statement, _ in REFUSED])
def test_a_damaged_row_is_written_anew_from_the_history(chain: MapStore, database_url: str, statement: str):
    before = graph_of(chain)
    tamper(chain, statement)
    store = reopened(database_url)
    assert check(store.database)
    repaired = store.repair("flat")
    assert repaired.revision == 3
    assert "written anew" in repaired.done[0]
    assert check(store.database) == []
    assert graph_of(store) == before
    assert graph_of(reopened(database_url)) == before
    assert store.undo("flat")[1] == 3


def test_a_node_without_features_goes_with_its_edges_and_an_undo_brings_it_back_without_them(
    chain: MapStore, told: Told
):
    before = graph_of(chain)
    damage(chain.database, before[0][1].features)
    told.clear()
    repaired = chain.repair("flat", "ann")
    assert repaired.done == ("node 1: removed, its features are lost",)
    assert [(delta.revision, delta.reset) for delta in told] == [(4, True)]
    assert (sorted(graph_of(chain)[0]), graph_of(chain)[1]) == ([0, 2], {})
    assert check(chain.database) == []
    newest = chain.revisions("flat", 99, 1)[0]
    assert (newest.author, newest.summary) == ("ann", "node 1 deleted with 2 edges")
    assert chain.undo("flat") == (5, 4)
    assert graph_of(chain) == before
    assert [entry.node_id for entry in chain.contents.features("flat", [])[1]] == [0, 2]
    chain.create("other")
    chain.transact("other", [add(1)])  # the same bytes once more heal it
    assert [entry.node_id for entry in chain.contents.features("flat", [])[1]] == [0, 1, 2]


def test_a_lost_thumbnail_costs_neither_the_node_nor_its_edges(chain: MapStore):
    damage(chain.database, graph_of(chain)[0][1].thumbnail)
    before = graph_of(chain)
    assert chain.repair("flat").done == ("node 1: its thumbnail is lost",)
    after = graph_of(chain)
    assert after[1] == before[1]
    assert after[0][1] == before[0][1].model_copy(update={"thumbnail": ""})
    assert check(chain.database) == []


def test_a_row_that_the_history_lacks_too_is_removed(chain: MapStore, database_url: str):
    tamper(chain, f"UPDATE revisions SET content = :new WHERE {FLAT} AND revision = 2", new=b"\x80")
    tamper(chain, f"UPDATE nodes SET record = '{{}}' WHERE {FLAT} AND node_id = 2")
    store = reopened(database_url)
    repaired = store.repair("flat")
    assert repaired.revision == 4
    assert any(line.startswith("node 2: removed") for line in repaired.done)
    assert (sorted(graph_of(store)[0]), sorted(graph_of(store)[1])) == ([0, 1], [(0, 1)])
    assert check(store.database) == []
    assert "node 2 deleted" in store.revisions("flat", 99, 1)[0].summary


def test_a_revision_that_was_given_up_says_so_and_undo_stops_there(chain: MapStore):
    tamper(chain, f"UPDATE revisions SET content = :new WHERE {FLAT} AND revision = 2", new=b"\x80")
    assert chain.repair("flat").done[0].startswith("revision 2: given up")
    assert check(chain.database) == []
    assert "a repair gave them up" in chain.revisions("flat", 3, 1)[0].summary
    assert chain.undo("flat")[1] == 3
    with pytest.raises(GivenUpError, match="revision 2: its operations were damaged"):
        chain.undo("flat")


def test_damaged_indexes_are_built_anew(
    chain: MapStore, database: Database, tmp_path: Path, database_url: str
):
    before = graph_of(chain)
    database.close()
    # In the index the checksum follows no bytes of its blob: its first copy after the tables' text is there.
    flip_first(tmp_path / "maps.sqlite3", before[0][1].features.encode())
    store = reopened(database_url)
    assert store.database.damage
    assert store.repair("flat").done[0].startswith("indexes of the file")
    assert check(store.database) == []
    assert graph_of(store) == before
    assert len(store.contents.features("flat", [])[1]) == 3


@pytest.mark.usefixtures("chain")
def test_a_file_with_more_than_damaged_indexes_is_left_alone(
    database: Database, tmp_path: Path, database_url: str
):
    database.close()
    file = tmp_path / "maps.sqlite3"
    data = bytearray(file.read_bytes())
    page = data.index(add(1).node.model_dump_json().encode()[:20]) // 4096 * 4096
    data[page + 7] ^= 9  # so many bytes are said to lie idle on this page
    file.write_bytes(data)
    store = reopened(database_url)
    with pytest.raises(CorruptError, match=r"more than indexes is damaged: .*restore a backup"):
        store.repair("flat")
    assert bytes(data) == file.read_bytes()


def test_a_repair_mends_the_records_of_missions_too(chain: MapStore):
    missions = MissionStore(chain.database)
    missions.claim("r1")
    tamper(chain, "UPDATE missions SET epoch = 9")
    assert chain.repair("flat").done == ("1 records of missions written anew",)
    assert check(chain.database) == []
    assert missions.claim("r1").epoch == 2


def test_a_sound_map_is_left_as_it_is(chain: MapStore):
    before = graph_of(chain)
    assert (chain.repair("flat").revision, chain.repair("flat").done) == (3, ())
    assert graph_of(chain) == before
    with pytest.raises(MissingError, match="no map 'garden'"):
        chain.repair("garden")


def test_rest_checks_and_repairs(client: TestClient, store: MapStore):
    assert client.get("/check").json() == {"damage": []}
    damage(store.database, store.graph("flat")[1].nodes[1].features)
    listed = client.get("/maps/flat/check").json()["damage"]
    assert [(entry["map"], entry["thing"]) for entry in listed] == [("flat", "features of node 1")]
    assert client.get("/maps/garden/check").status_code == 404
    told = client.post("/maps/flat/repair", headers={"X-Topnav-Author": "ann"}).json()
    assert told == {"map": "flat", "revision": 3, "done": ["node 1: removed, its features are lost"]}
    assert client.get("/check").json() == {"damage": []}


def test_a_map_that_is_set_back_is_not_mixed_up_with_what_it_was(chain: MapStore):
    tamper(chain, f"DELETE FROM revisions WHERE {FLAT} AND revision = 3")
    tamper(chain, "UPDATE maps SET changed_ns = 1 WHERE name = 'flat'")
    assert chain.repair("flat").revision == 2
    assert chain.transact("flat", [add(3)]) == 3
    assert sorted(graph_of(chain)[0]) == [0, 1, 2, 3]
