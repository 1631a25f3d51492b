"""Damaged rows: what belongs to them is refused and named, everything else is served, a check lists them."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import text

from services.map_store.errors import CorruptError, MissingError
from services.map_store.integrity.check import check
from services.map_store.service import answer_map
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from shared.messages.maps import DeleteNode, MapRequest
from tests.unit.services.map_store.conftest import add
from tests.unit.services.map_store.test_store import damage, link, reopened


@pytest.fixture
def two(store: MapStore) -> MapStore:
    """Map "flat" with two nodes and an edge in two revisions, map "house" with one node."""
    store.transact("flat", [add(0), add(1)], author="planner")
    store.transact("flat", [link(0, 1)], author="planner")
    store.create("house")
    store.transact("house", [add(7)])
    return store


def tamper(store: MapStore, statement: str, **values: bytes) -> None:
    """Change rows behind the store's back."""
    with store.database.write() as connection:
        connection.execute(text(statement), values)


FLAT = "map_id = (SELECT map_id FROM maps WHERE name = 'flat')"
REFUSED = (
    (f"UPDATE nodes SET record = replace(record, 'sift', 'soft') WHERE {FLAT} AND node_id = 1", "node 1"),
    (f"UPDATE nodes SET features = (SELECT max(sha256) FROM blobs) WHERE {FLAT} AND node_id = 0", "node 0"),
    (f"UPDATE nodes SET quarantined = true WHERE {FLAT} AND node_id = 1", "node 1"),
    (f"UPDATE edges SET record = replace(record, '0.5', '0.7') WHERE {FLAT}", "edge 0-1"),
    (f"UPDATE edges SET revision = 1 WHERE {FLAT}", "edge 0-1"),
    (f"DELETE FROM edges WHERE {FLAT}", "1 edges"),
    ("UPDATE maps SET revision = 1 WHERE name = 'flat'", "its record is damaged"),
    ("UPDATE maps SET edge_count = 9 WHERE name = 'flat'", "its record is damaged"),
)


@pytest.mark.parametrize(("statement", "named"), REFUSED)
def test_a_map_with_a_damaged_row_is_refused_by_name_and_the_others_are_served(
    two: MapStore, database_url: str, statement: str, named: str
):
    tamper(two, statement)
    store = reopened(database_url)
    with pytest.raises(CorruptError, match=f"map 'flat': .*{named}.* 'topnav map repair flat'"):
        store.graph("flat")
    with pytest.raises(CorruptError, match="map 'flat'"):
        store.transact("flat", [DeleteNode(node_id=0)])
    assert answer_map(store, "house", MapRequest(action="read")).nodes == (add(7).node,)
    assert store.transact("house", [add(8)]) == 2
    assert {found.map for found in check(store.database)} == {"flat"}


def test_a_name_that_was_changed_does_not_look_like_a_map_that_never_was(two: MapStore):
    tamper(two, "UPDATE maps SET name = 'flau' WHERE name = 'flat'")
    with pytest.raises(CorruptError, match=r"no map 'flat', and 1 records of maps are damaged"):
        two.graph("flat")
    with pytest.raises(CorruptError, match="map 'flau': its record is damaged"):
        two.graph("flau")
    assert [record.name for record in two.summaries()] == ["house"]


def test_a_damaged_revision_is_listed_as_such_and_ends_undo(two: MapStore):
    tamper(two, f"UPDATE revisions SET author = 'nobody' WHERE {FLAT} AND revision = 1")
    assert [entry.summary for entry in two.revisions("flat", 99, 99)] == [
        "edge 0-1 put",
        "unreadable: its record does not match its checksum",
    ]
    assert two.undo("flat") == (3, 2)
    with pytest.raises(CorruptError, match=r"revision 1: its record .*; what is older cannot be undone"):
        two.undo("flat")


def test_a_missing_revision_is_listed_as_such(two: MapStore):
    tamper(two, f"DELETE FROM revisions WHERE {FLAT} AND revision = 1")
    listed = two.revisions("flat", 99, 99)
    assert [(entry.revision, entry.summary[:10]) for entry in listed] == [
        (2, "edge 0-1 p"),
        (1, "unreadable"),
    ]
    assert [found.thing for found in check(two.database, "flat")] == ["revision 1"]


def test_an_epoch_that_was_changed_is_not_believed(two: MapStore):
    missions = MissionStore(two.database)
    assert [missions.claim("r1").epoch for _ in range(3)] == [1, 2, 3]
    tamper(two, "UPDATE missions SET epoch = 1")
    assert [(found.map, found.thing) for found in check(two.database)] == [("", "mission of 'r1'")]
    assert missions.claim("r1").epoch == 4


def test_a_check_names_every_damaged_thing(two: MapStore):
    flat = two.graph("flat")[1]
    damage(two.database, flat.nodes[0].features)
    damage(two.database, flat.nodes[1].thumbnail)
    tamper(two, f"UPDATE edges SET revision = 1 WHERE {FLAT}")
    tamper(two, f"UPDATE revisions SET content = :new WHERE {FLAT} AND revision = 2", new=b"\x80")
    found = [(each.map, each.thing) for each in check(two.database)]
    assert sorted(found) == [
        ("flat", "edge 0-1"),
        ("flat", "features of node 0"),
        ("flat", "revision 2"),
        ("flat", "thumbnail of node 1"),
    ]
    assert check(two.database, "house") == []
    with pytest.raises(MissingError, match="no map 'garden'"):
        check(two.database, "garden")


@pytest.mark.usefixtures("two")
def test_a_reference_that_is_no_text_any_more_does_not_end_a_check(database: Database, tmp_path: Path):
    with closing(sqlite3.connect(tmp_path / "maps.sqlite3")) as connection, connection:
        connection.execute("UPDATE nodes SET features = x'00' WHERE node_id = 1")
    assert {("flat", "node 1"), ("", "file")} == {(each.map, each.thing) for each in check(database)}


@pytest.mark.usefixtures("two")
def test_nothing_is_written_to_a_file_that_is_damaged_but_what_is_whole_is_read(
    database: Database, tmp_path: Path, database_url: str
):
    database.close()
    flip_first(tmp_path / "maps.sqlite3", b"flat", after=b"flat")
    store = reopened(database_url)
    assert store.database.damage
    assert store.graph("house")[0] == 1
    with pytest.raises(CorruptError, match="nothing was written, the file is damaged"):
        store.transact("house", [add(8)])


@pytest.mark.usefixtures("two")
def test_tables_that_are_described_otherwise_are_refused(
    database: Database, tmp_path: Path, database_url: str
):
    database.close()
    flip_first(tmp_path / "maps.sqlite3", b"REFERENCES maps")
    with pytest.raises(CorruptError, match="description of the tables is damaged"):
        reopened(database_url)


@pytest.mark.usefixtures("two")
def test_a_description_that_is_no_text_any_more_is_refused(
    database: Database, tmp_path: Path, database_url: str
):
    database.close()
    flip_first(tmp_path / "maps.sqlite3", b"FOREIGN KEY(map_id) REFERENCES", mask=0x80)
    with pytest.raises(CorruptError, match="its description is damaged"):
        reopened(database_url)


def flip_first(file: Path, words: bytes, after: bytes = b"", mask: int = 1) -> None:
    """Change the last byte of the first place where `words` stand, or of the next one after `after`."""
    data = bytearray(file.read_bytes())
    start = data.index(after) + len(after) if after else 0
    data[data.index(words, start) + len(words) - 1] ^= mask
    file.write_bytes(data)
