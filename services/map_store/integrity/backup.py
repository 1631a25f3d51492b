"""The whole database as one file: copied while it is in use, and put back while it is not."""

import fcntl
import os
import shutil
import sqlite3
import time
from collections.abc import Iterator
from contextlib import closing, contextmanager
from pathlib import Path
from typing import IO
from urllib.parse import quote

from services.map_store.errors import (
    ConflictError,
    CorruptError,
    InvalidError,
    MissingError,
    StorageFullError,
)
from services.map_store.integrity.check import check
from services.map_store.storage.database import Database
from services.map_store.storage.engines import BUSY_TIMEOUT_S, is_sqlite, parse, text_of

SHOWN = 3
"""Damaged things in one message: it stays a line or two, and `topnav map check` lists all."""


def file_of(url: str) -> Path:
    """The file of a SQLite database; InvalidError for another one, which has tools of its own."""
    parsed = parse(url)
    if not is_sqlite(parsed) or not parsed.database:
        raise InvalidError(
            f"only a SQLite file can be copied, got {parsed.render_as_string()}; "
            "of PostgreSQL use pg_dump and pg_restore, or your provider's backups"
        )
    return Path(parsed.database)


def back_up(source: Path, file: Path) -> int:
    """Copy the database in `source`, one moment of it, to `file`; returns how many maps it holds.

    Others may read and write meanwhile. A backup that is there already is replaced once the copy was checked.

    Raises:
        MissingError: no database there.
        InvalidError: what is there already is no backup, or a database in use.
        ConflictError: another backup to `file` is being made.
        CorruptError: it is damaged; the older backup stays.
        StorageFullError: no room for the copy.
    """
    if not source.exists():
        raise MissingError(f"no database {source}")
    with _new_beside(file) as new:
        if file.exists():
            _require_replaceable(file, source)
        with _open(source) as live, closing(sqlite3.connect(new)) as copy:
            live.backup(copy)
        found = _require_sound(new)
        _replace(new, file)
    return found


def put_back(file: Path, target: Path) -> Path | None:
    """Put a checked copy of `file` in the place of the database `target`, in one step.

    Returns:
        Where the database that was there is kept.

    Raises:
        InvalidError: `file` is no database of maps.
        CorruptError: it is damaged; nothing was changed.
        ConflictError: a map store works on `target`.
    """
    _require_maps(file)
    target.parent.mkdir(parents=True, exist_ok=True)
    with _new_beside(target) as new:
        shutil.copyfile(file, new)
        _require_sound(new)
        kept = _keep(target) if target.exists() else None
        _replace(new, target)
    return kept


@contextmanager
def _new_beside(file: Path) -> Iterator[Path]:
    """A name for a file under construction, which is gone afterwards and nobody else's meanwhile."""
    new = file.with_name(file.name + ".new")
    try:
        with _alone(new, file):
            yield new
    except (sqlite3.Error, UnicodeDecodeError) as error:
        kind = StorageFullError if "full" in str(error) else CorruptError
        raise kind(f"{file}: {error}; nothing was changed") from error


@contextmanager
def _alone(new: Path, file: Path) -> Iterator[None]:
    """Hold the empty file `new` while the block runs; one that a killed process left is taken over.

    Raises:
        ConflictError: another process holds it.
    """
    busy = ConflictError(f"{file} is being written by another process: try again when that is done")
    with new.open("ab") as held:
        try:
            fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise busy from None
        if not _is_at(held, new):
            raise busy  # who held it has just put it in its place
        held.truncate(0)
        try:
            yield
        finally:
            if _is_at(held, new):
                for left in (Path(f"{new}-wal"), Path(f"{new}-shm"), Path(f"{new}-journal"), new):
                    left.unlink(missing_ok=True)


def _is_at(opened: IO[bytes], path: Path) -> bool:
    """Whether an open file is the one of that name."""
    try:
        return os.path.samestat(os.fstat(opened.fileno()), path.stat())
    except FileNotFoundError:
        return False


def _require_replaceable(file: Path, source: Path) -> None:
    logs = [log for log in (Path(f"{file}-wal"), Path(f"{file}-shm")) if log.exists()]
    if file.samefile(source) or logs:
        raise InvalidError(f"{file} is a database in use, no backup: name another file")
    try:
        _require_maps(file)
    except CorruptError as error:
        raise InvalidError(
            f"{file} exists and is no backup of maps: name another file, or delete it"
        ) from error


@contextmanager
def _open(file: Path) -> Iterator[sqlite3.Connection]:
    """A connection to a file that is there; a plain one would make an empty database."""
    uri = f"file:{quote(str(file.resolve()))}?mode=rw"
    with closing(sqlite3.connect(uri, uri=True, timeout=BUSY_TIMEOUT_S)) as connection:
        connection.text_factory = text_of
        yield connection


def _require_maps(file: Path) -> None:
    if not file.is_file():
        raise MissingError(f"no file {file}")
    try:
        with _open(file) as connection:
            found = connection.execute(
                "SELECT name FROM sqlite_master WHERE name IN ('about', 'maps')"
            ).fetchall()
    except (sqlite3.Error, UnicodeDecodeError) as error:
        raise CorruptError(f"{file}: {error}; nothing was changed") from error
    if len(found) < 2:
        raise InvalidError(f"{file} is no backup of maps")


def _require_sound(file: Path) -> int:
    """Check everything in a copy, bringing it up to this version; returns how many maps it holds."""
    database = Database(f"sqlite:///{file.resolve()}")
    try:
        found = check(database)
        if found:
            first = "; ".join(f"{d.map} {d.thing}: {d.reason}".strip() for d in found[:SHOWN])
            raise CorruptError(f"{len(found)} things are damaged: {first}; nothing was changed")
        with database.read() as connection:
            return int(connection.exec_driver_sql("SELECT count(*) FROM maps").scalar_one())
    finally:
        database.close()


def _keep(target: Path) -> Path:
    """Copy the database that is there as it is, damaged or not, then make sure that nobody uses it."""
    kept = target.with_name(f"{target.name}.before-{time.strftime('%Y%m%dT%H%M%SZ', time.gmtime())}")
    log = Path(f"{target}-wal")
    copies = {target: kept} | ({log: Path(f"{kept}-wal")} if log.exists() else {})
    for file, copy in copies.items():
        shutil.copyfile(file, copy)
    try:
        with _open(target) as old:
            old.execute("PRAGMA journal_mode=DELETE")  # ends the log; refused while somebody else is there
    except sqlite3.OperationalError as error:
        if "locked" in str(error):
            for copy in copies.values():
                copy.unlink()
            raise ConflictError(f"{target} is in use: stop the map store first") from error
    except (sqlite3.DatabaseError, UnicodeDecodeError):
        pass  # damaged, so its log is still there
    for suffix in ("-wal", "-shm"):  # SQLite would apply an old log to the new file
        Path(f"{target}{suffix}").unlink(missing_ok=True)
    return kept


def _replace(new: Path, file: Path) -> None:
    """Put `new` in the place of `file` so that a power cut leaves one or the other."""
    with new.open("rb") as written:
        os.fsync(written.fileno())
    new.replace(file)
    folder = os.open(file.resolve().parent, os.O_RDONLY)
    try:
        os.fsync(folder)
    finally:
        os.close(folder)
