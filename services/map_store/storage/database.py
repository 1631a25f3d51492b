"""Transactions: one writer at a time, any number of readers, on a SQLite file or a PostgreSQL server."""

import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

from sqlalchemy import Connection
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from services.map_store.errors import CorruptError, MapError, StorageFullError, UnavailableError
from services.map_store.integrity import sqlite_file as integrity
from services.map_store.storage import migration
from services.map_store.storage.engines import BUSY_TIMEOUT_S, is_sqlite, open_engines, parse

log = logging.getLogger(__name__)

SHOWN = 5
"""Lines of damage in the log; `topnav map check` lists all."""
FULL = ("database or disk is full", "no space left", "disk full", "could not extend file")
BUSY = "lock timeout"
MALFORMED = ("malformed", "not a database", "too big")
ADVICE = "'topnav map check' lists the damage; 'topnav map repair' or 'topnav map restore' ends it"


class Database:
    """Transactions on the database at `url`; it is created when it is not there.

    A SQLite file is read as a whole first. A damaged one is served as far as it can be read and never
    written to, because SQLite may overwrite good pages through a bad one. A server looks after its own files;
    several map stores may write to its database, in turns.

    Attributes:
        damage: what is wrong with the file.

    Raises:
        UnavailableError: no such URL, no driver for it, no connection, or tables of a later version.
        CorruptError: so much is damaged that nothing can be read.
    """

    def __init__(self, url: str) -> None:
        self._lock = threading.Lock()
        parsed = parse(url)
        self._where = parsed.render_as_string()  # without the password
        self._sqlite = is_sqlite(parsed)
        self._writer, self._reader = open_engines(parsed)
        self.damage: tuple[str, ...] = ()
        try:
            self.inspect()
            if not self.damage:
                with self.read() as connection:
                    migration.refuse_later(connection)
                with self.write() as connection:
                    migration.prepare(connection)
            with self.read() as connection:
                migration.require(connection)
        except MapError as error:
            self.close()
            raise type(error)(f"{self._where}: {error}") from error

    def inspect(self) -> tuple[str, ...]:
        """Read the whole file and note what is wrong with it."""
        if self._sqlite:
            try:
                with self.read() as connection:
                    self.damage = integrity.damage(connection)
            except CorruptError as error:  # so damaged that the inspection itself ended
                self.damage = (str(error),)
        for line in self.damage[:SHOWN]:
            log.error("%s: %s", self._where, line)
        return self.damage

    def rebuild_indexes(self, then: Callable[[Connection], None]) -> None:
        """Write the indexes of a damaged file anew and call `then` in the same transaction.

        Raises:
            CorruptError: that does not make it sound; nothing was changed.
        """
        with self._lock, self._translated(), self._reader.begin() as connection:  # no log for a file unmended
            integrity.rebuild_indexes(connection)
            damage = integrity.damage(connection)
            if damage:
                raise CorruptError(f"more than indexes is damaged: {damage[0]}; restore a backup")
            then(connection)
        self.inspect()

    def dangling(self) -> tuple[str, ...]:
        """Rows that refer to a row that is not there; a server checks that by itself."""
        if not self._sqlite:
            return ()
        with self.read() as connection:
            return integrity.dangling(connection)

    @contextmanager
    def write(self) -> Iterator[Connection]:
        """One transaction of the only writer: all of it or nothing."""
        if self.damage:
            raise CorruptError(f"nothing was written, the file is damaged: {self.damage[0]}; {ADVICE}")
        with self._lock, self._translated(), self._writer.begin() as connection:
            yield connection

    @contextmanager
    def read(self) -> Iterator[Connection]:
        """One consistent view, never waiting for the writer."""
        with self._translated(), self._reader.begin() as connection:
            yield connection

    def close(self) -> None:
        """Close every connection."""
        self._writer.dispose()
        self._reader.dispose()

    @contextmanager
    def _translated(self) -> Iterator[None]:
        """Turn the driver's errors into ours."""
        try:
            yield
        except MapError:
            raise
        except UnicodeDecodeError as error:  # SQLite names the damaged thing with its damaged name
            raise CorruptError(f"database: its description is damaged; {ADVICE}") from error
        except SQLAlchemyError as error:
            cause = str(error.orig if isinstance(error, DBAPIError) else error).strip()
            if any(sign in cause.lower() for sign in FULL):
                raise StorageFullError(
                    f"nothing was written: {cause}: {self._where}; free some space, reads go on"
                ) from error
            if BUSY in cause.lower():
                raise UnavailableError(
                    f"database: another map store writes since {BUSY_TIMEOUT_S:g} s; try again"
                ) from error
            if any(sign in cause.lower() for sign in MALFORMED):
                raise CorruptError(f"database: {cause[:200]}; {ADVICE}") from error
            raise UnavailableError(f"database: {type(error).__name__}: {cause[:200]}") from error
