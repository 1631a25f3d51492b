"""A database of every earlier version of the tables opens with everything in it."""

import gzip
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from services.map_store.errors import CorruptError, UnavailableError
from services.map_store.integrity.check import check
from services.map_store.storage import migration, tables
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from shared.messages.maps import Edge
from shared.wire import encode
from tests.unit.services.map_store.conftest import add, app_of, features

STORED = Path(__file__).parent / "data"
"""Maps "flat" (five revisions, one of them an undo) and "loft", and a mission of robot r1, by version.

Names end with the commit whose own code wrote the file: dd495c3 is the first that kept maps.
a6fad33 wrote its version 4 over the version 3 of a2174e2.
"""


def copy_of(version: int | str, folder: Path) -> Path:
    copy = folder / "maps.sqlite3"
    copy.write_bytes(gzip.decompress((STORED / f"version_{version}.sqlite3.gz").read_bytes()))
    return copy


@pytest.fixture(params=["1_dd495c3", 1, 2, "3_sealed", "3_a2174e2", "4_a6fad33"])
def file(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A copy of a stored database; the one of this version was sealed by an earlier program."""
    return copy_of(request.param, tmp_path)


@pytest.fixture
def first(tmp_path: Path) -> Path:
    """A copy of what version 0.1.0 of the program wrote, without seals."""
    return copy_of(1, tmp_path)


def opened(file: Path) -> MapStore:
    return MapStore(Database(f"sqlite:///{file}"), lambda: 5_000, lambda _: None)


def test_maps_histories_and_missions_are_there_and_sound(file: Path):
    store = opened(file)
    assert check(store.database) == []
    assert [(r.name, r.revision, r.node_count, r.edge_count) for r in store.summaries()] == [
        ("flat", 5, 3, 2),
        ("loft", 1, 2, 0),
    ]
    assert store.graph("flat")[1].edges[(0, 1)] == Edge(a=0, b=1, inliers=7, heading_ab_rad=0.5, why="test")
    kept = store.contents.features("flat", [])[1]
    assert [encode(entry.features) for entry in kept] == [
        encode(features(number, thumbnail=False)) for number in range(3)
    ]
    history = [(entry.revision, entry.author, entry.undoes) for entry in store.revisions("flat", 99, 2)]
    assert history == [(5, "rest", 4), (4, "rest", None)]
    mission = MissionStore(store.database).claim("r1")
    assert (mission.epoch, mission.mission_id, mission.step) == (2, "m-1", 12)


def test_pictures_are_read_and_an_export_is_imported_as_the_same_map(file: Path):
    client = TestClient(app_of(opened(file)))
    assert client.get("/check").json() == {"damage": []}
    pictures = [client.get(f"/maps/flat/nodes/{number}/thumbnail").content for number in range(3)]
    assert pictures == [features(number).thumbnail for number in range(3)]
    archive = client.get("/maps/flat/export").content
    assert client.post("/maps/import", params={"name": "copy"}, content=archive).status_code == 201
    for part in ("nodes", "edges"):
        flat, copy = (client.get(f"/maps/{name}/{part}").json() for name in ("flat", "copy"))
        assert [one | {"revision": 0} for one in flat] == [one | {"revision": 0} for one in copy]
    assert client.get("/maps/copy/nodes/2/thumbnail").content == pictures[2]


def test_it_is_written_undone_and_opened_again(file: Path):
    store = opened(file)
    assert store.transact("flat", [add(3)], base_revision=5) == 6
    assert [store.undo("flat")[1] for _ in range(2)] == [6, 3]
    store.database.close()
    again = opened(file)
    assert again.graph("flat")[0] == 8
    assert check(again.database) == []


def test_every_earlier_version_is_kept_for_these_tests():
    kept = {int(path.name.split("_")[1].split(".")[0]) for path in STORED.iterdir()}
    assert kept >= set(range(1, tables.VERSION))


@pytest.mark.parametrize("noted", [False, True])
def test_what_a_seal_of_the_whole_file_left_in_its_header_is_ignored(tmp_path: Path, noted: bool):
    """An earlier program of version 3 kept a checksum there, or -1 where it had found a byte changed."""
    file = copy_of("3_sealed", tmp_path)
    with closing(sqlite3.connect(file, isolation_level=None)) as connection:
        assert connection.execute("PRAGMA user_version").fetchone() != (0,)
        if noted:
            connection.execute("PRAGMA application_id = -1")
    store = opened(file)
    assert check(store.database) == []
    assert store.repair("flat").done == ()
    store.database.close()


def test_a_record_that_cannot_be_read_is_not_sealed_as_if_it_were_good(first: Path):
    with closing(sqlite3.connect(first)) as connection, connection:
        connection.execute("UPDATE nodes SET record = '{' WHERE node_id = 5")
    store = opened(first)
    assert [(each.map, each.thing) for each in check(store.database)] == [("loft", "node 5")]
    assert store.graph("flat")[0] == 5


def test_a_migration_that_fails_leaves_the_old_tables(first: Path, monkeypatch: pytest.MonkeyPatch):
    def fail(*_: object) -> None:
        raise CorruptError("broken off")

    with monkeypatch.context() as broken:
        broken.setattr(migration, "_write_about", fail)
        with pytest.raises(CorruptError, match="broken off"):
            opened(first)
    with closing(sqlite3.connect(first)) as connection:
        assert connection.execute("SELECT * FROM about").fetchall() == [(1,)]
        assert "seal" not in {row[1] for row in connection.execute("PRAGMA table_info(nodes)")}
    assert check(opened(first).database) == []


@pytest.mark.parametrize("change", ["", "ALTER TABLE answers RENAME TO replies"], ids=["same", "renamed"])
def test_a_later_version_is_refused_without_a_byte_written(file: Path, change: str):
    opened(file).database.close()
    with closing(sqlite3.connect(file)) as connection, connection:
        connection.execute(f"UPDATE about SET version = {tables.VERSION + 1}")
        connection.execute(change)
    before = file.read_bytes(), file.stat().st_mtime_ns
    with pytest.raises(
        UnavailableError, match=r"tables of version 5 expected, got \[6\]; export the maps with"
    ):
        opened(file)
    assert (file.read_bytes(), file.stat().st_mtime_ns) == before
    assert list(file.parent.iterdir()) == [file]
