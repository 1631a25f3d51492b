"""The file as a whole: damage is read around, unused bytes do not matter, lawful writers are no damage."""

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
from services.map_store.integrity.backup import back_up, put_back
from services.map_store.integrity.check import check
from shared.messages.maps import DeleteNode
from tests.faults.lived_maps import live, opened, place

UNUSED = 72
"""A byte of the header that SQLite keeps for later and never reads."""


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A file after much use; to be copied."""
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


def test_a_change_where_nothing_is_kept_stops_nothing(file: Path, tmp_path: Path):
    flip(file, UNUSED)
    store = opened(file)
    assert check(store.database) == []
    assert store.transact("flat", [place(700)]) > 0
    assert store.repair("house").done == ()
    store.database.close()
    back_up(file, tmp_path / "copy")
    flip(tmp_path / "copy", UNUSED)
    put_back(tmp_path / "copy", file)
    store = opened(file)
    assert check(store.database) == []
    store.database.close()


@pytest.mark.parametrize("mode", ["WAL", "DELETE"])
def test_a_damaged_file_is_read_without_a_byte_written(file: Path, lived: Path, mode: str):
    shell(file, f"PRAGMA journal_mode = {mode}")
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
    shell(file, "PRAGMA journal_mode = DELETE")
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


FOREIGN: dict[str, Callable[[Path], None]] = {
    "the map store": use,
    "killed": forget,
    "cp": copy_while_open,
    "power cut": cut_off_in_rollback_mode,
    "backup": backed_up,
    "vacuum": lambda file: shell(file, "VACUUM"),
    "no log": lambda file: shell(file, "PRAGMA journal_mode=DELETE", "CREATE TABLE x(y)", "DROP TABLE x"),
}
"""Every way in which the file lawfully becomes another one."""


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(2))
def test_any_sequence_of_lawful_writers_is_no_damage(file: Path, seed: int):
    rng = random.Random(seed)
    names = list(FOREIGN) * 2
    rng.shuffle(names)
    for name in names:
        FOREIGN[name](file)
        store = opened(file)
        assert check(store.database) == [], name
        store.database.close()
