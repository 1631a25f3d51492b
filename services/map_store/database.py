"""Connections: one writer at a time, any number of readers. Everything that only SQLite needs is here."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event, insert, select
from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from services.map_store import tables
from services.map_store.errors import MapError, StorageFullError, UnavailableError

BUSY_TIMEOUT_S = 5.0
FULL = ("database or disk is full", "no space left", "disk full", "could not extend file")


class Database:
    """Transactions on the database at `url`; it is created when it is not there.

    Raises:
        UnavailableError: no connection, or tables of another version.
    """

    def __init__(self, url: str) -> None:
        self._lock = threading.Lock()
        parsed = make_url(url)
        self._writer, self._reader = _sqlite_engines(parsed) if _is_sqlite(parsed) else _engines(parsed)
        with self.write() as connection:
            tables.metadata.create_all(connection)
            versions = connection.execute(select(tables.about.c.version)).scalars().all()
            if not versions:
                connection.execute(insert(tables.about).values(version=tables.VERSION))
            elif versions != [tables.VERSION]:
                raise UnavailableError(
                    f"{parsed.render_as_string()}: tables of version {tables.VERSION} expected, got "
                    f"{versions}; export the maps with the version that wrote them and import them here"
                )

    @contextmanager
    def write(self) -> Iterator[Connection]:
        """One transaction of the only writer: all of it or nothing."""
        with self._lock, _translated(), self._writer.begin() as connection:
            yield connection

    @contextmanager
    def read(self) -> Iterator[Connection]:
        """One consistent view, never waiting for the writer."""
        with _translated(), self._reader.begin() as connection:
            yield connection

    def close(self) -> None:
        """Close every connection."""
        self._writer.dispose()
        self._reader.dispose()


def _is_sqlite(url: URL) -> bool:
    return url.get_backend_name() == "sqlite"


def _engines(url: URL) -> tuple[Engine, Engine]:
    engine = create_engine(url, isolation_level="REPEATABLE READ", pool_pre_ping=True)
    return engine, engine


def _sqlite_engines(url: URL) -> tuple[Engine, Engine]:
    if not url.database or url.database == ":memory:":
        raise UnavailableError("database_url must name a file, for example sqlite:///data/maps.sqlite3")
    Path(url.database).parent.mkdir(parents=True, exist_ok=True)
    return _sqlite_engine(url, "BEGIN IMMEDIATE"), _sqlite_engine(url, "BEGIN")


def _sqlite_engine(url: URL, begin: str) -> Engine:
    """An engine whose transactions start with `begin`: a plain BEGIN that writes later fails as "locked"."""
    engine = create_engine(url, connect_args={"timeout": BUSY_TIMEOUT_S})

    @event.listens_for(engine, "connect")
    def _prepare(connection: Any, _record: object) -> None:
        connection.isolation_level = None  # the driver shall not begin transactions by itself
        for pragma in ("journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
            connection.execute(f"PRAGMA {pragma}").close()

    @event.listens_for(engine, "begin")
    def _begin(connection: Connection) -> None:
        connection.exec_driver_sql(begin)

    return engine


@contextmanager
def _translated() -> Iterator[None]:
    """Turn the driver's errors into ours."""
    try:
        yield
    except MapError:
        raise
    except SQLAlchemyError as error:
        cause = str(error.orig if isinstance(error, DBAPIError) else error).strip()
        if any(sign in cause.lower() for sign in FULL):
            raise StorageFullError(f"nothing was written: {cause}; free some space, reads go on") from error
        raise UnavailableError(f"database: {type(error).__name__}: {cause[:200]}") from error
