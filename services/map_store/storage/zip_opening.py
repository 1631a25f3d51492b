"""Opening a zip from outside: its directory is bounded before it is read."""

import struct
import zipfile
from typing import IO, Any

from services.map_store.errors import InvalidError


def open_zip(file: IO[bytes], max_directory_bytes: int) -> zipfile.ZipFile:
    """Open a zip whose directory has at most `max_directory_bytes`.

    The directory names every entry in 46 bytes and its name. `zipfile` reads it whole and makes an object of
    each entry: one of 35 MB costs 100 MB and seconds.

    Raises:
        InvalidError: no zip, or a longer directory.
    """
    bounded = _Bounded(file, max_directory_bytes)
    try:
        archive = zipfile.ZipFile(bounded)
    except (zipfile.BadZipFile, OSError, ValueError, EOFError, NotImplementedError, struct.error) as error:
        raise InvalidError(f"not a zip archive: {error}") from error
    bounded.most_bytes = None
    assert isinstance(archive, zipfile.ZipFile)
    return archive


class _Bounded:
    """A file of which no read is longer than `most_bytes`; None for any length."""

    def __init__(self, file: IO[bytes], most_bytes: int | None) -> None:
        self._file = file
        self.most_bytes = most_bytes

    def read(self, length: int = -1) -> bytes:
        if self.most_bytes is None:
            return self._file.read(length)
        data = self._file.read(self.most_bytes + 1 if length < 0 else min(length, self.most_bytes + 1))
        if len(data) > self.most_bytes:
            raise InvalidError(f"the archive's directory must have at most {self.most_bytes} bytes")
        return data

    def __getattr__(self, name: str) -> Any:
        return getattr(self._file, name)
