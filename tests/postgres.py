"""A PostgreSQL server of its own for tests: a temporary folder, a socket in it, no port and no root."""

import itertools
import os
import pwd
import shutil
import signal
import subprocess
import tempfile
import time
from pathlib import Path

START_S = 60.0
USERS = ("postgres", "nobody")
"""Whom a root process starts it as: the server refuses root."""


def missing() -> str:
    """Why no server can be started here; "" when one can."""
    try:
        import psycopg  # noqa: F401
    except ImportError:
        return "no driver for PostgreSQL: pip install 'topnav[postgres]'"
    if programs() is None:
        return "no PostgreSQL server here: apt-get install postgresql"
    return ""


def programs() -> Path | None:
    """Folder of initdb and postgres: Debian keeps them out of the path, one folder for each version."""
    found = shutil.which("initdb")
    if found is not None:
        return Path(found).resolve().parent
    newest = sorted(Path("/usr/lib/postgresql").glob("*/bin/initdb"), key=lambda path: int(path.parts[-3]))
    return newest[-1].parent if newest else None


class PostgresServer:
    """A server that tests may kill and start again; `close` removes everything.

    Args:
        durable: whether a commit waits for the disk, as in service; without it tests are faster.
    """

    def __init__(self, durable: bool = False) -> None:
        found = programs()
        assert found is not None
        self._bin, self._durable = found, durable
        self._account = _unprivileged()
        self._folder = Path(tempfile.mkdtemp(prefix="topnav-pg-"))
        self._child: subprocess.Popen[bytes] | None = None
        self._numbers = itertools.count()
        if self._account:
            os.chown(self._folder, self._account.pw_uid, self._account.pw_gid)
        words = ["--username=topnav", "--auth=trust", "--encoding=UTF8", "--locale=C", "--no-sync"]
        self._run("initdb", f"--pgdata={self._data}", *words)

    @property
    def _data(self) -> Path:
        return self._folder / "data"

    def start(self) -> None:
        """Start it and wait until it answers."""
        words = ["-D", str(self._data), "-k", str(self._folder), "-c", "listen_addresses="]
        words += ["-c", f"fsync={'on' if self._durable else 'off'}", "-c", "shared_buffers=32MB"]
        with (self._folder / "log").open("ab") as log:
            self._child = subprocess.Popen([str(self._bin / "postgres"), *words], stderr=log, **self._who())
        deadline_s = time.monotonic() + START_S
        ready = [str(self._bin / "pg_isready"), "-q", "-h", str(self._folder), "-d", "postgres"]
        while subprocess.run(ready, check=False).returncode != 0:
            told = (self._folder / "log").read_text(encoding="utf-8", errors="replace")
            assert self._child.poll() is None, told
            assert time.monotonic() < deadline_s, told
            time.sleep(0.1)

    def stop(self, how: signal.Signals = signal.SIGQUIT) -> None:
        """Stop it at once, without a clean end: the next start recovers from the log."""
        if self._child is not None and self._child.poll() is None:
            self._child.send_signal(how)
            self._child.wait(30)

    def close(self) -> None:
        """Stop it and remove its folder."""
        self.stop()
        shutil.rmtree(self._folder, ignore_errors=True)

    def new_database(self) -> str:
        """URL of an empty database that nobody else uses."""
        name = f"maps{next(self._numbers)}"
        self.sql("postgres", f"CREATE DATABASE {name}")
        return f"postgresql://topnav@/{name}?host={self._folder}"

    def new_schema(self) -> str:
        """URL of an empty part of one database: quicker to make; the writers' lock is that of all parts."""
        name = f"maps{next(self._numbers)}"
        self.sql("postgres", f"CREATE SCHEMA {name}")
        return f"postgresql://topnav@/postgres?host={self._folder}&options=-csearch_path%3D{name}"

    def sql(self, database: str, command: str) -> str:
        """What psql answers, without decoration."""
        words = [str(self._bin / "psql"), "-X", "-A", "-t", "-v", "ON_ERROR_STOP=1", "-h", str(self._folder)]
        done = subprocess.run(
            [*words, "-U", "topnav", "-d", database, "-c", command],
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        return done.stdout.strip()

    def _run(self, program: str, *words: str) -> None:
        done = subprocess.run(
            [str(self._bin / program), *words], capture_output=True, text=True, check=False, **self._who()
        )
        assert done.returncode == 0, done.stderr

    def _who(self) -> dict:
        if self._account is None:
            return {"cwd": self._folder}
        account = self._account
        return {"cwd": self._folder, "user": account.pw_uid, "group": account.pw_gid, "extra_groups": []}


def _unprivileged() -> pwd.struct_passwd | None:
    if os.geteuid() != 0:
        return None
    known = {entry.pw_name: entry for entry in pwd.getpwall()}
    return next(known[name] for name in USERS if name in known)
