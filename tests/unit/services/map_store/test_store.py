"""Transactions: all or nothing, one revision and one delta each, kept over a restart, taken back by undo."""

from threading import Thread

import pytest
from sqlalchemy import func, select, update

from services.map_store.errors import (
    ConflictError,
    CorruptError,
    InvalidError,
    MissingError,
    StorageFullError,
    UnavailableError,
)
from services.map_store.integrity.seals import sealed
from services.map_store.storage import tables
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, MissionRecord, Node, PutEdge, UpdateNode
from shared.wire import encode
from tests.unit.services.map_store.conftest import Told, add, features


def link(a: int, b: int, inliers: int = 1) -> PutEdge:
    return PutEdge(edge=Edge(a=a, b=b, inliers=inliers, heading_ab_rad=0.5, why="test"))


def graph_of(store: MapStore) -> tuple[dict, dict]:
    _, graph = store.graph("flat")
    return dict(graph.nodes), dict(graph.edges)


def reopened(url: str) -> MapStore:
    return MapStore(Database(url), lambda: 0, lambda _: None)


def test_a_transaction_counts_one_revision_and_tells_one_delta(store: MapStore, told: Told):
    assert store.transact("flat", [add(0), add(1), link(0, 1)], author="planner") == 1
    assert [(delta.revision, delta.reset, len(delta.operations)) for delta in told] == [(1, False, 3)]
    assert told[0].author == "planner"


def test_deltas_carry_features_but_no_thumbnails(store: MapStore, told: Told):
    store.transact("flat", [add(0)])
    sent = told[0].operations[0].features
    assert encode(sent) == encode(features(0, thumbnail=False))


def test_nothing_is_kept_of_a_transaction_that_fails(store: MapStore, told: Told):
    store.transact("flat", [add(0)])
    before = graph_of(store)
    with pytest.raises(MissingError, match=r"operation 1 \(put_edge\): node 9 does not exist"):
        store.transact("flat", [add(1), link(0, 9)])
    assert graph_of(store) == before
    assert store.summary("flat").revision == 1
    assert len(told) == 1
    with store.database.read() as connection:
        assert connection.execute(select(func.count()).select_from(tables.blobs)).scalar() == 2


def test_a_writer_with_an_old_base_is_refused(store: MapStore):
    store.transact("flat", [add(0)], base_revision=0)
    with pytest.raises(ConflictError, match="at revision 1, not 0; read it again"):
        store.transact("flat", [add(1)], base_revision=0)


def test_an_empty_transaction_is_refused(store: MapStore):
    with pytest.raises(InvalidError, match="at least one operation"):
        store.transact("flat", [])


def test_what_was_written_is_there_after_a_restart(store: MapStore, database_url: str):
    store.transact("flat", [add(0), add(1), add(2), link(0, 1), link(1, 2)])
    store.transact(
        "flat", [DeleteNode(node_id=0), UpdateNode(node=Node(node_id=1, keypoints=5)), link(1, 2, 7)]
    )
    store.transact("flat", [DeleteEdge(a=1, b=2), add(3), link(2, 3)])
    assert graph_of(reopened(database_url)) == graph_of(store)


def test_a_node_deleted_and_added_again_in_one_transaction_gets_its_new_content(
    store: MapStore, database_url: str
):
    store.transact("flat", [add(0), add(1), link(0, 1)])
    again = add(1).model_copy(update={"features": features(99)})
    store.transact("flat", [DeleteNode(node_id=1), again, link(0, 1, 5)])
    for opened in (store, reopened(database_url)):
        _, found = opened.contents.features("flat", [1])
        assert encode(found[0].features) == encode(features(99, thumbnail=False))
        assert opened.graph("flat")[1].edges[0, 1].inliers == 5


def test_undo_goes_back_one_revision_each_time_and_is_a_revision_itself(
    store: MapStore, told: Told, database_url: str
):
    states = [graph_of(store)]
    for operations in ([add(0), add(1), link(0, 1)], [link(0, 1, 9)], [DeleteNode(node_id=0)]):
        store.transact("flat", operations)
        states.append(graph_of(store))
    told.clear()
    assert store.undo("flat") == (4, 3)
    assert graph_of(store) == states[2]
    assert store.undo("flat") == (5, 2)
    assert graph_of(store) == states[1]
    assert graph_of(reopened(database_url)) == states[1]
    assert [(delta.revision, delta.reset) for delta in told] == [(4, True), (5, True)]


def test_undo_after_new_work_takes_back_the_new_work_first(store: MapStore):
    store.transact("flat", [add(0)])
    store.transact("flat", [add(1)])
    store.undo("flat")
    store.transact("flat", [add(2)])
    assert store.undo("flat")[1] == 4
    assert store.undo("flat")[1] == 1
    with pytest.raises(MissingError, match="nothing left to undo"):
        store.undo("flat")
    assert [entry.undoes for entry in store.revisions("flat", 2**62, 10)] == [1, 4, None, 2, None, None]


def test_a_node_marked_by_an_earlier_version_is_written_on(store: MapStore, database_url: str):
    """Damaged features were once noted in the row, and its checksum covers the note."""
    store.transact("flat", [add(0)])
    with store.database.write() as connection:
        row = connection.execute(select(tables.nodes)).one()
        marked = sealed(tables.nodes, {**row._mapping, "quarantined": True})
        connection.execute(update(tables.nodes).values(marked))
    again = reopened(database_url)
    again.transact("flat", [UpdateNode(node=Node(node_id=0, keypoints=5))])
    assert graph_of(reopened(database_url))[0][0].node.keypoints == 5


def test_undo_brings_a_deleted_node_back_with_its_pictures(store: MapStore):
    store.transact("flat", [add(0)])
    store.transact("flat", [DeleteNode(node_id=0)])
    store.undo("flat")
    _, found = store.contents.features("flat", [])
    assert encode(found[0].features) == encode(features(0, thumbnail=False))
    place = store.graph("flat")[1].nodes[0]
    assert store.contents.read("flat", place, "thumbnail") == features(0).thumbnail


def test_names_are_checked_and_errors_list_the_maps(store: MapStore):
    with pytest.raises(MissingError, match=r"no map 'house'; maps: \['flat'\]"):
        store.graph("house")
    with pytest.raises(ConflictError, match="map 'flat' exists already"):
        store.create("flat")
    for name in ("", "..", "a/b", "A", "x" * 65, "flat\n", "a\0"):
        with pytest.raises(InvalidError, match="map name must match"):
            store.create(name)


def test_renaming_keeps_everything_and_resets_followers_of_both_names(store: MapStore, told: Told):
    store.transact("flat", [add(0)])
    told.clear()
    store.rename("flat", "house")
    assert [summary.name for summary in store.summaries()] == ["house"]
    assert [(delta.map, delta.reset, delta.renamed_to) for delta in told] == [
        ("house", True, ""),
        ("flat", True, "house"),
    ]


def test_a_mission_is_in_its_map_under_the_new_name(store: MapStore):
    missions = MissionStore(store.database)
    missions.save(MissionRecord(robot="r1", action="explore", map="flat", step=7))
    missions.save(MissionRecord(robot="r2", action="explore", map="loft"))
    store.rename("flat", "house")
    assert [missions.claim(robot).map for robot in ("r1", "r2")] == ["house", "loft"]
    assert missions.claim("r1").step == 7


def test_deleting_a_map_frees_only_blobs_that_no_other_map_uses(store: MapStore):
    store.create("other")
    store.transact("flat", [add(0), add(1)])
    store.transact("other", [add(1)])
    store.delete("flat")
    assert len(store.contents.features("other", [])[1]) == 1
    with store.database.read() as connection:
        assert connection.execute(select(func.count()).select_from(tables.blobs)).scalar() == 2
    store.create("flat")
    assert store.graph("flat")[0] == 0
    assert graph_of(store) == ({}, {})


def damage(database: Database, sha256: str) -> None:
    with database.write() as connection:
        data = connection.execute(
            select(tables.blobs.c.data).where(tables.blobs.c.sha256 == sha256)
        ).scalar_one()
        flipped = data[:-1] + bytes([data[-1] ^ 1])
        connection.execute(update(tables.blobs).where(tables.blobs.c.sha256 == sha256).values(data=flipped))


def test_a_node_with_damaged_features_is_left_out_and_the_others_are_served(store: MapStore):
    store.transact("flat", [add(0), add(1)])
    stored = store.graph("flat")[1].nodes[0]
    damage(store.database, stored.features)
    assert [entry.node_id for entry in store.contents.features("flat", [])[1]] == [1]
    with pytest.raises(CorruptError, match=r"map 'flat', node 0: features: .*checksum"):
        store.contents.read("flat", stored, "features")
    with store.database.read() as connection:
        everything = set(connection.execute(select(tables.blobs.c.sha256)).scalars())
        assert store.contents.damaged(connection, everything) == {stored.features}


def test_writing_the_same_content_again_heals_a_damaged_blob(store: MapStore):
    store.transact("flat", [add(0)])
    damage(store.database, store.graph("flat")[1].nodes[0].features)
    store.contents.features("flat", [])
    store.create("backup")
    store.transact("backup", [add(0)])
    with store.database.read() as connection:
        assert not store.contents.damaged(connection, [store.graph("flat")[1].nodes[0].features])
    assert len(store.contents.features("flat", [])[1]) == 1


def test_a_full_disk_refuses_writes_and_goes_on_reading(store: MapStore, told: Told):
    store.transact("flat", [add(0)])
    with store.database._writer.connect() as connection:
        connection.exec_driver_sql("PRAGMA max_page_count = 1")  # SQLite then reports the disk as full
    big = add(1).model_copy(update={"features": features(1).model_copy(update={"thumbnail": bytes(150_000)})})
    with pytest.raises(StorageFullError, match=r"nothing was written: .*full"):
        store.transact("flat", [big])
    assert store.graph("flat")[0] == 1
    assert len(store.contents.features("flat", [0])[1]) == 1
    assert len(told) == 1


def test_two_threads_never_lose_a_write_and_deltas_stay_in_order(store: MapStore, told: Told):
    def work(first: int) -> None:
        for number in range(first, first + 20):
            store.transact("flat", [add(number)])

    threads = [Thread(target=work, args=(first,)) for first in (0, 100)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(store.graph("flat")[1].nodes) == 40
    assert [delta.revision for delta in told] == list(range(1, 41))


def test_a_second_process_on_the_same_database_is_seen(store: MapStore, database_url: str):
    store.transact("flat", [add(0)])
    other = reopened(database_url)
    other.transact("flat", [add(1)])
    assert store.transact("flat", [link(0, 1)]) == 3
    assert set(other.graph("flat")[1].edges) == {(0, 1)}


def test_a_database_of_another_version_is_refused(database: Database, database_url: str):
    with database.write() as connection:
        connection.execute(update(tables.about).values(version=tables.VERSION + 1))
    with pytest.raises(UnavailableError, match="tables of version"):
        Database(database_url)
