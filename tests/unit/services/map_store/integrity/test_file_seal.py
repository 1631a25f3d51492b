"""A file at rest is sealed to its last byte: any change is noticed, and no lawful writer is taken for one."""

import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import pytest

from services.map_store.errors import CorruptError
from services.map_store.integrity import file_seal
from services.map_store.integrity.backup import back_up, put_back
from services.map_store.integrity.check import check, check_contents
from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.messages.maps import DeleteNode
from tests.faults.lived_maps import live, opened, place

IDLE = 72
"""A byte of the header that SQLite keeps for later and never reads."""


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A sealed file after much use; to be copied."""
    file = tmp_path_factory.mktemp("lived") / "maps.sqlite3"
    live(file)
    return file


@pytest.fixture
def file(lived: Path, tmp_path: Path) -> Path:
    """The same, to be changed."""
    return Path(shutil.copyfile(lived, tmp_path / "maps.sqlite3"))


def flip(file: Path, offset: int, mask: int = 1) -> None:
    with file.open("r+b") as raw:
        raw.seek(offset)
        byte = raw.read(1)[0]
        raw.seek(offset)
        raw.write(bytes([byte ^ mask]))


def test_one_changed_bit_anywhere_is_noticed(file: Path):
    rng = random.Random(5)
    size = file.stat().st_size
    assert not file_seal.changed(file)
    for offset in [*range(file_seal.HEADER), *rng.sample(range(size), 300), size - 1]:
        mask = 1 << rng.randrange(8)
        flip(file, offset, mask)
        assert file_seal.changed(file), offset
        flip(file, offset, mask)
    assert not file_seal.changed(file)


def test_bytes_cut_off_or_appended_are_noticed(file: Path):
    data = file.read_bytes()
    for other in (data[:-1], data[:-4096], data + b"\0"):
        file.write_bytes(other)
        assert file_seal.changed(file)


def test_a_change_where_nothing_is_kept_is_told_but_stops_nothing_until_a_repair_ends_it(file: Path):
    flip(file, IDLE)
    for restart in range(3):
        store = opened(file)
        assert [(found.thing, found.reason) for found in check(store.database)] == [("file", file_seal.TOLD)]
        assert store.transact("flat", [place(700 + restart)]) > 0
        store.database.close()
    store = opened(file)
    assert store.repair("house").done == ("bytes of the file that hold nothing: taken as they are",)
    for _ in range(2):
        assert check(store.database) == []
        store.database.close()
        assert not file_seal.changed(file)
        store = opened(file)
    store.database.close()


def test_a_repair_does_not_end_it_while_something_kept_is_damaged(file: Path, lived: Path):
    flip(file, lived.read_bytes().index(place(105).features.descriptors.tobytes()[:16]))
    store = opened(file)
    store.repair("house")
    assert {found.map for found in check(store.database)} == {"flat", ""}
    store.repair("flat")
    assert check(store.database) == []
    store.database.close()


def test_a_backup_with_a_change_where_nothing_is_kept_is_put_back_whole(file: Path, tmp_path: Path):
    copy = tmp_path / "copy"
    back_up(file, copy)
    assert not file_seal.changed(copy)
    flip(copy, IDLE)
    assert file_seal.changed(copy)
    put_back(copy, file)
    store = opened(file)
    assert check(store.database) == []
    store.database.close()


@pytest.mark.parametrize("sealed", [True, False])
def test_a_damaged_file_is_read_without_a_byte_written(file: Path, lived: Path, sealed: bool):
    if not sealed:
        shell(file, "PRAGMA application_id = 0")
    flip(file, lived.read_bytes().index(b"flat", 8192), 4)  # in a leaf of an index or of the maps
    before = file.read_bytes()
    store = opened(file)
    assert store.database.damage
    assert store.graph("house")[0] > 0
    with pytest.raises(CorruptError, match="nothing was written"):
        store.create("more")
    store.database.close()
    assert file.read_bytes() == before
    assert [path.name for path in file.parent.iterdir()] == [file.name]


def test_pictures_of_a_deleted_map_are_gone_from_the_file(file: Path):
    picture = place(903).features.thumbnail
    store = opened(file)
    store.create("private")
    store.transact("private", [place(903)])
    store.database.close()
    assert picture[:40] in file.read_bytes()
    store = opened(file)
    store.delete("private")
    store.database.close()
    assert picture[:40] not in file.read_bytes()


def test_a_file_in_use_is_not_sealed_and_whoever_leaves_last_seals_it(file: Path):
    one, two = Database(f"sqlite:///{file}"), Database(f"sqlite:///{file}")
    log_off = (
        "import sqlite3, sys; sqlite3.connect(sys.argv[1], timeout=0).execute('PRAGMA journal_mode=DELETE')"
    )
    refused = subprocess.run(
        [sys.executable, "-c", log_off, str(file)], check=False, capture_output=True, text=True
    )
    assert "database is locked" in refused.stderr
    one.close()
    MapStore(two, lambda: 1, lambda _: None).create("more")
    two.close()
    assert not Path(f"{file}-wal").exists()
    flip(file, IDLE)
    assert file_seal.changed(file)


def test_a_file_that_is_gone_when_it_is_closed_is_not_made_again(file: Path):
    database = Database(f"sqlite:///{file}")
    for left in file.parent.iterdir():
        left.unlink()
    database.close()
    assert not file.exists()


def test_a_file_that_another_release_of_sqlite_wrote_is_sealed(file: Path):
    shell(file, "PRAGMA application_id = 0")
    flip(file, 98)
    assert file_seal.seal(file)
    assert not file_seal.changed(file)
    flip(file, IDLE)
    assert file_seal.changed(file)


def shell(file: Path, *statements: str) -> None:
    """What a person does with another program."""
    with closing(sqlite3.connect(file, isolation_level=None)) as connection:
        for statement in statements:
            connection.execute(statement).fetchall()


def use(file: Path) -> None:
    store = opened(file)
    number = random.Random(os.urandom(4)).randrange(2_000, 9_000)
    store.transact("flat", [place(number, number % 150 + 1)])
    store.undo("flat")
    store.transact("flat", [place(number), DeleteNode(node_id=number)])
    store.database.close()


def forget(file: Path) -> None:
    """As a process that ends without closing."""
    program = (
        "import os, pathlib, sys; from tests.faults.lived_maps import opened\n"
        "opened(pathlib.Path(sys.argv[1])).undo('attic'); os.kill(os.getpid(), 9)"
    )
    ended = subprocess.run([sys.executable, "-c", program, str(file)], check=False)
    assert ended.returncode == -signal.SIGKILL


def copy_while_open(file: Path) -> None:
    """The file alone, without its log, as a careless backup takes it."""
    store = opened(file)
    store.undo("house")
    taken = subprocess.run(["cp", str(file), f"{file}.taken"], check=True)
    assert taken.returncode == 0
    store.database.close()
    Path(f"{file}.taken").replace(file)


def cut_off_in_rollback_mode(file: Path) -> None:
    """Half of a transaction is in the file and its journal beside it, as a power cut leaves them."""
    with closing(sqlite3.connect(file, isolation_level=None)) as connection:
        connection.execute("PRAGMA cache_size = 1")
        connection.execute("BEGIN IMMEDIATE")
        connection.execute("UPDATE blobs SET size = size + 1")
        for suffix in ("", "-journal"):
            subprocess.run(["cp", f"{file}{suffix}", f"{file}.cut{suffix}"], check=True)
        connection.execute("ROLLBACK")
    for suffix in ("-journal", ""):
        Path(f"{file}.cut{suffix}").replace(f"{file}{suffix}")


def backed_up(file: Path) -> None:
    back_up(file, file.with_name("copy"))
    file.with_name("copy").replace(file)


def copied_by_sqlite(file: Path) -> None:
    shell(file, f"VACUUM INTO '{file}.copy'")
    Path(f"{file}.copy").replace(file)


FOREIGN: dict[str, Callable[[Path], None]] = {
    "the map store": use,
    "killed": forget,
    "cp": copy_while_open,
    "power cut": cut_off_in_rollback_mode,
    "backup": backed_up,
    "vacuum into": copied_by_sqlite,
    "vacuum": lambda file: shell(file, "VACUUM"),
    "reading": lambda file: shell(file, "SELECT count(*) FROM nodes", "PRAGMA integrity_check"),
    "taken back": lambda file: shell(file, "BEGIN IMMEDIATE", "UPDATE blobs SET size = 0", "ROLLBACK"),
    "no log": lambda file: shell(file, "PRAGMA journal_mode=DELETE", "CREATE TABLE x(y)", "DROP TABLE x"),
    "log": lambda file: shell(file, "PRAGMA journal_mode=WAL", "CREATE TABLE x(y)", "DROP TABLE x"),
}
"""Every way in which the file lawfully becomes another one."""


@pytest.mark.parametrize("name", FOREIGN)
def test_a_lawful_writer_is_no_damage(file: Path, name: str):
    FOREIGN[name](file)
    assert not file_seal.changed(file)
    store = opened(file)
    assert check_contents(store.database) == check(store.database) == []
    store.database.close()
    flip(file, IDLE)
    assert file_seal.changed(file)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_any_sequence_of_lawful_writers_is_no_damage(file: Path, seed: int):
    rng = random.Random(seed)
    for _ in range(25):
        name = rng.choice(list(FOREIGN))
        FOREIGN[name](file)
        assert not file_seal.changed(file), name
        if rng.random() < 0.5:
            store = opened(file)
            assert check(store.database) == [], name
            store.database.close()
