"""Backups: taken while maps are written, checked before they replace anything, put back in one step."""

import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path
from threading import Thread

import pytest

from services.map_store.errors import ConflictError, CorruptError, InvalidError, MissingError
from services.map_store.integrity.backup import back_up, file_of, put_back
from services.map_store.integrity.check import check
from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from tests.unit.services.map_store.conftest import add
from tests.unit.services.map_store.storage.test_migration import STORED
from tests.unit.services.map_store.storage.test_migration import file as version_1
from tests.unit.services.map_store.test_damage import flip_first
from tests.unit.services.map_store.test_store import damage, graph_of, reopened

__all__ = ["STORED", "version_1"]


@pytest.fixture
def live(store: MapStore, tmp_path: Path) -> Path:
    """The file of a store that is open and has two nodes."""
    store.transact("flat", [add(0), add(1)])
    return tmp_path / "maps.sqlite3"


def graph_in(file: Path) -> tuple[dict, dict]:
    store = MapStore(Database(f"sqlite:///{file}"), lambda: 0, lambda _: None)
    assert check(store.database) == []
    found = graph_of(store)
    store.database.close()
    return found


def test_a_backup_is_one_moment_of_a_store_that_is_being_written(store: MapStore, live: Path, tmp_path: Path):
    numbers = range(2, 40)
    writer = Thread(target=lambda: [store.transact("flat", [add(number)]) for number in numbers])
    writer.start()
    assert back_up(live, tmp_path / "b.sqlite3") == 1
    writer.join()
    kept = sorted(graph_in(tmp_path / "b.sqlite3")[0])
    assert kept == list(range(len(kept)))
    assert len(kept) >= 2
    assert len(store.graph("flat")[1].nodes) == 40
    assert not list(tmp_path.glob("*.new*"))


def test_two_backups_to_one_file_at_once_leave_a_whole_one(store: MapStore, live: Path, tmp_path: Path):
    """With one name for what both were writing, one told of success and left a database without maps."""
    for number in range(2, 30):
        store.transact("flat", [add(number)])
    copy = tmp_path / "b.sqlite3"
    assert back_up(live, copy) == 1
    code = "import sys; from pathlib import Path; from services.map_store.integrity.backup import back_up\n"
    code += "for _ in range(8):\n  try: print(back_up(Path(sys.argv[1]), Path(sys.argv[2])))\n"
    code += "  except Exception as error: print(type(error).__name__)\n"
    runs = [
        subprocess.Popen(
            [sys.executable, "-c", code, str(live), str(copy)], stdout=subprocess.PIPE, text=True
        )
        for _ in range(2)
    ]
    told = " ".join(run.communicate(timeout=150)[0] for run in runs).split()
    assert set(told) <= {"1", "ConflictError"}
    assert "1" in told
    assert len(graph_in(copy)[0]) == 30
    assert not list(tmp_path.glob("*.new*"))


def test_what_a_killed_backup_left_is_taken_over(store: MapStore, live: Path, tmp_path: Path):
    assert store
    (tmp_path / "b.sqlite3.new").write_bytes(b"half of it")
    assert back_up(live, tmp_path / "b.sqlite3") == 1
    assert len(graph_in(tmp_path / "b.sqlite3")[0]) == 2


@pytest.mark.parametrize("name", ["maps.sqlite3", "notes.txt", "other.sqlite3"])
def test_nothing_but_a_backup_is_replaced_by_one(store: MapStore, live: Path, tmp_path: Path, name: str):
    (tmp_path / "notes.txt").write_text("mine")
    other = MapStore(Database(f"sqlite:///{tmp_path / 'other.sqlite3'}"), lambda: 0, lambda _: None)
    other.create("theirs")
    before = (tmp_path / name).read_bytes()
    with pytest.raises(InvalidError, match="name another file"):
        back_up(live, tmp_path / name)
    assert (tmp_path / name).read_bytes() == before
    assert len(store.graph("flat")[1].nodes) == 2
    other.database.close()


def test_a_damaged_database_does_not_replace_a_good_backup(store: MapStore, live: Path, tmp_path: Path):
    copy = tmp_path / "b.sqlite3"
    back_up(live, copy)
    good = copy.read_bytes()
    damage(store.database, store.graph("flat")[1].nodes[0].features)
    with pytest.raises(
        CorruptError, match=r"1 things are damaged: flat features of node 0: .*nothing was changed"
    ):
        back_up(live, copy)
    assert copy.read_bytes() == good
    with pytest.raises(MissingError, match="no database"):
        back_up(tmp_path / "nothing", copy)


def test_a_restore_keeps_what_was_there(store: MapStore, live: Path, tmp_path: Path):
    before = graph_of(store)
    back_up(live, tmp_path / "b.sqlite3")
    store.transact("flat", [add(2)])
    after = graph_of(store)
    store.database.close()
    kept = put_back(tmp_path / "b.sqlite3", live)
    assert kept is not None
    assert graph_in(live) == before
    assert graph_in(kept) == after


def test_a_restore_after_kill_9_leaves_no_log_of_the_old_file(store: MapStore, live: Path, tmp_path: Path):
    back_up(live, tmp_path / "b.sqlite3")
    store.transact("flat", [add(2)])
    killed = tmp_path / "killed" / "maps.sqlite3"  # as kill -9 leaves it: the last write is only in the log
    killed.parent.mkdir()
    for suffix in ("", "-wal"):
        Path(f"{killed}{suffix}").write_bytes(Path(f"{live}{suffix}").read_bytes())
    kept = put_back(tmp_path / "b.sqlite3", killed)
    assert kept is not None
    assert len(graph_in(killed)[0]) == 2
    assert len(graph_in(kept)[0]) == 3


def test_a_restore_replaces_even_a_file_that_is_no_database_any_more(
    store: MapStore, live: Path, tmp_path: Path
):
    back_up(live, tmp_path / "b.sqlite3")
    with closing(sqlite3.connect(live, isolation_level=None)) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)").close()
        connection.execute("UPDATE maps SET changed_ns = 5")  # the log then holds one page, and not the first
        log = Path(f"{live}-wal").read_bytes()
    store.database.close()
    live.write_bytes(b"rubbish" * 1_000)
    Path(f"{live}-wal").write_bytes(log)  # SQLite would apply it to the file that is put back
    kept = put_back(tmp_path / "b.sqlite3", live)
    assert kept is not None
    assert kept.read_bytes() == b"rubbish" * 1_000
    assert Path(f"{kept}-wal").read_bytes() == log
    assert len(graph_in(live)[0]) == 2


def test_a_database_in_use_is_not_replaced(store: MapStore, live: Path, tmp_path: Path):
    back_up(live, tmp_path / "b.sqlite3")
    with pytest.raises(ConflictError, match="in use: stop the map store first"):
        put_back(tmp_path / "b.sqlite3", live)
    assert store.transact("flat", [add(2)]) == 2


def test_what_is_no_sound_backup_changes_nothing(store: MapStore, live: Path, tmp_path: Path):
    copy, other, text = tmp_path / "b.sqlite3", tmp_path / "other.sqlite3", tmp_path / "text"
    back_up(live, copy)
    flip_first(copy, add(0).node.model_dump_json().encode())
    with closing(sqlite3.connect(other)) as connection:
        connection.execute("CREATE TABLE t (a)")
    text.write_text("no database" * 1_000)
    store.database.close()
    before = live.read_bytes()
    for file, kind, told in (
        (copy, CorruptError, "things are damaged: flat "),
        (other, InvalidError, "is no backup of maps"),
        (text, CorruptError, "not a database"),
        (tmp_path / "nothing", MissingError, "no file"),
    ):
        with pytest.raises(kind, match=told):
            put_back(file, live)
    assert live.read_bytes() == before
    assert graph_of(reopened(f"sqlite:///{tmp_path}/maps.sqlite3"))[0].keys() == {0, 1}
    assert not list(tmp_path.glob("*before*"))


def test_a_backup_of_an_older_version_is_brought_up_to_date(version_1: Path, tmp_path: Path):
    assert put_back(version_1, tmp_path / "new" / "maps.sqlite3") is None
    assert len(graph_in(tmp_path / "new" / "maps.sqlite3")[0]) == 3


def test_only_a_sqlite_file_can_be_copied():
    assert file_of("sqlite:////var/maps.sqlite3") == Path("/var/maps.sqlite3")
    with pytest.raises(InvalidError, match="only a SQLite file can be copied, got postgresql"):
        file_of("postgresql+psycopg://me:secret@host/maps")
