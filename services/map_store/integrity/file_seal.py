"""The seal of a closed SQLite file: a checksum over every byte of it, also of those that hold nothing.

Rows have seals of their own, and what these leave out (free pages, gaps in pages) is never read: a changed
byte there does no harm, but tells that a disk or a copy is not to be trusted. SQLite leaves residues in gaps,
so only a file at rest can be held against a checksum.

Two numbers of the header that are an application's own keep the seal: user_version is the CRC-32 of the file
with both numbers taken as 0, application_id the file's change counter. In rollback mode, in which a file is
left, every transaction of any program raises that counter: who writes without sealing makes the seal void,
never wrong.
"""

import sqlite3
import zlib
from contextlib import closing
from pathlib import Path
from typing import BinaryIO

from sqlalchemy import Connection

HEADER, CHUNK = 100, 1 << 20
COUNTER, CRC, SEALED_AT, VALID_FOR, WRITTEN_BY = (slice(at, at + 4) for at in (24, 60, 68, 92, 96))
NOTED = -1
"""application_id of a file in which changed bytes were found, until a repair."""
TOLD = (
    "bytes changed while it was closed; what 'topnav map check' does not name is whole, and once it names "
    "nothing else, 'topnav map repair' of any map ends this; look after the disk"
)


def changed(file: Path) -> bool:
    """Whether bytes changed since the file was sealed; False where nobody can know, as while it is in use.

    To be called before this process connects to it: closing a file ends all of a process's locks on it.
    """
    try:
        return file.is_file() and not _in_use(file) and _changed(file)
    except OSError:  # it cannot be read, and SQLite will say so
        return False


def seal(file: Path) -> bool:
    """Leave the file in rollback mode and sealed; False when somebody else uses it or it cannot be written.

    Nothing is lost then, only changes of unused bytes go unnoticed. To be called without a connection open.
    """
    try:
        uri = f"{file.resolve().as_uri()}?mode=rw"  # a file that is gone shall not be there again
        with closing(sqlite3.connect(uri, uri=True, isolation_level=None, timeout=0)) as connection:
            mode = connection.execute("PRAGMA journal_mode = DELETE").fetchone()
            return mode == ("delete",) and _seal(file, connection)
    except (sqlite3.Error, UnicodeDecodeError, OSError):
        return False


def noted(connection: Connection) -> bool:
    """Whether changed bytes were found in this file before, and not repaired."""
    return bool(connection.exec_driver_sql("PRAGMA application_id").scalar_one() == NOTED)


def note(connection: Connection, found: bool) -> None:
    """Remember in the file itself, over restarts, that changed bytes were found, or that this is settled."""
    connection.exec_driver_sql(f"PRAGMA application_id = {NOTED if found else 0}")


def _changed(file: Path) -> bool:
    with file.open("rb") as raw:
        header = raw.read(HEADER)
        if len(header) < HEADER:
            return False
        crc = _crc(raw, header)
        sealed = header[SEALED_AT] in (header[COUNTER], header[VALID_FOR])  # one of them may be what changed
        if sealed == (header[CRC] == _word(crc)):
            return False  # as it was sealed, or written to since
        raw.seek(0)  # again: a program may have been writing, and then it leaves traces or another result
        return raw.read(HEADER) == header and _crc(raw, header) == crc and not _in_use(file)


def _seal(file: Path, connection: sqlite3.Connection) -> bool:
    """Write the numbers in one transaction, for a header as that transaction makes it."""
    with file.open("rb") as raw:  # closed after the transaction, see `changed`
        connection.execute("BEGIN")
        connection.execute("SELECT count(*) FROM sqlite_master").fetchone()  # nobody writes from here on
        header = bytearray(raw.read(HEADER))
        counter = (int.from_bytes(header[COUNTER]) + 1) % 2**32
        header[COUNTER] = header[VALID_FOR] = header[SEALED_AT] = _word(counter)
        header[WRITTEN_BY] = _word(_library_version())
        header[CRC] = _word(_crc(raw, header))
        for name, part in (("application_id", SEALED_AT), ("user_version", CRC)):
            connection.execute(f"PRAGMA {name} = {int.from_bytes(header[part], signed=True)}")
        connection.execute("COMMIT")
        raw.seek(0)
        if raw.read(HEADER) == header:
            return True
        connection.execute("PRAGMA application_id = 0")  # a library that writes other headers: no seal then
        return False


def _crc(raw: BinaryIO, header: bytes | bytearray) -> int:
    """Checksum of `header` without its seal and of all that follows it in the file."""
    bare = bytearray(header)
    bare[CRC] = bare[SEALED_AT] = bytes(4)
    crc = zlib.crc32(bare)
    raw.seek(HEADER)
    while chunk := raw.read(CHUNK):
        crc = zlib.crc32(chunk, crc)
    return crc


def _in_use(file: Path) -> bool:
    """Whether a log lies beside it: of a program at work, or of one that was killed."""
    return any(Path(f"{file}{suffix}").exists() for suffix in ("-wal", "-journal"))


def _library_version() -> int:
    major, minor, patch = sqlite3.sqlite_version_info
    return major * 1_000_000 + minor * 1_000 + patch


def _word(number: int) -> bytes:
    return number.to_bytes(4)
