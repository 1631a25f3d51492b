"""Engines of the two databases: a writer whose transactions take turns, and readers that never wait."""

from pathlib import Path
from typing import Any

from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.engine import URL, make_url
from sqlalchemy.exc import ArgumentError

from services.map_store.errors import UnavailableError

BUSY_TIMEOUT_S = 5.0
"""So long a writer waits for another process's transaction; one takes 29 ms (decision 0007)."""
CONNECT_TIMEOUT_S = 5
"""As long as a writer waits."""
HUNG_AFTER_S = 20
"""Four times as long; then a server ends the transaction of a map store that hangs, and the others go on."""
WRITER_LOCK = 0x746F706E
"""Name of the writers' lock on a server ("topn"): nobody else who uses the database shall take it."""
PRAGMAS = ("synchronous=FULL", "foreign_keys=ON", "secure_delete=ON", "journal_size_limit=64000000")
"""For a file: what is acknowledged is on the disk, what is deleted becomes zeros there, and the log of one
long transaction does not keep its length for ever."""
DRIVERS = {"postgresql": "postgresql+psycopg", "postgres": "postgresql+psycopg"}
"""URLs as operators and providers hand them out."""


def parse(url: str) -> URL:
    """The URL with the driver that is installed here.

    Raises:
        UnavailableError: not a URL of SQLite or PostgreSQL.
    """
    scheme, separator, rest = url.partition(":")
    try:
        parsed = make_url(DRIVERS.get(scheme, scheme) + separator + rest)
        known = parsed.get_backend_name() in ("sqlite", "postgresql")
    except (ArgumentError, ValueError) as error:  # its text may hold a password
        raise UnavailableError(f"database_url is no URL of a database ({type(error).__name__})") from None
    if not known:
        raise UnavailableError(
            f"database_url must begin with sqlite:/// or postgresql://, got {parsed.drivername}://"
        )
    return parsed


def is_sqlite(url: URL) -> bool:
    """Whether the maps are kept in a file."""
    return url.get_backend_name() == "sqlite"


def open_engines(url: URL) -> tuple[Engine, Engine]:
    """Writer and reader; nothing is connected yet.

    Raises:
        UnavailableError: a SQLite URL without a file, or a driver that is not installed.
    """
    return _sqlite_engines(url) if is_sqlite(url) else _server_engines(url)


def _server_engines(url: URL) -> tuple[Engine, Engine]:
    """Writers stand in line by a lock of the server, as `BEGIN IMMEDIATE` has them do for a file.

    The lock comes before the first look at a table, and READ COMMITTED looks at what is there then: a
    snapshot of before the wait would miss what the others wrote meanwhile.
    """
    reach = {"connect_timeout": CONNECT_TIMEOUT_S, "application_name": "topnav-map-store"}
    try:
        writer = create_engine(
            url, isolation_level="READ COMMITTED", pool_pre_ping=True, pool_size=1, connect_args=reach
        )
        reader = create_engine(
            url,
            isolation_level="REPEATABLE READ",
            pool_pre_ping=True,
            connect_args=reach,
            execution_options={"postgresql_readonly": True},
        )
    except ModuleNotFoundError as error:
        raise UnavailableError(
            f"{url.drivername} needs a driver that is not installed ({error.name}): "
            "pip install 'topnav[map-store,postgres]'"
        ) from error

    @event.listens_for(writer, "begin")
    def _take_turn(connection: Connection) -> None:
        connection.exec_driver_sql(
            f"SELECT set_config('lock_timeout', '{BUSY_TIMEOUT_S}s', true), "
            f"set_config('idle_in_transaction_session_timeout', '{HUNG_AFTER_S}s', true)"
        )
        connection.exec_driver_sql(f"SELECT pg_advisory_xact_lock({WRITER_LOCK})")

    return writer, reader


def _sqlite_engines(url: URL) -> tuple[Engine, Engine]:
    """Only the writer begins a log beside the file: nobody who reads a damaged one changes it."""
    if not url.database or url.database == ":memory:":
        raise UnavailableError("database_url must name a file, for example sqlite:///data/maps.sqlite3")
    Path(url.database).parent.mkdir(parents=True, exist_ok=True)
    writer = _sqlite_engine(url, "BEGIN IMMEDIATE", ("journal_mode=WAL", *PRAGMAS))
    return writer, _sqlite_engine(url, "BEGIN", PRAGMAS)


def _sqlite_engine(url: URL, begin: str, pragmas: tuple[str, ...]) -> Engine:
    """An engine whose transactions start with `begin`: a plain BEGIN that writes later fails as "locked"."""
    engine = create_engine(url, connect_args={"timeout": BUSY_TIMEOUT_S})

    @event.listens_for(engine, "connect")
    def _prepare(connection: Any, _record: object) -> None:
        connection.isolation_level = None  # the driver shall not begin transactions by itself
        connection.text_factory = text_of
        for pragma in pragmas:
            connection.execute(f"PRAGMA {pragma}").close()

    @event.listens_for(engine, "begin")
    def _begin(connection: Connection) -> None:
        connection.exec_driver_sql(begin)

    return engine


def text_of(data: bytes) -> str:
    """Damaged text need not be UTF-8; it must reach the checks as text that differs, not as an exception."""
    return data.decode("utf-8", "backslashreplace")
