"""Arrays kept on disk between starts: written whole or not at all, checked on reading, bounded in size.

A key is a hash of everything that decides an entry, the code and its libraries included.

An entry is one file, `<key>.npys`: the arrays one after another in NumPy's own format, then the SHA-256 of
the key and of all that. Whatever does not carry the right seal, cut short, overwritten or renamed, counts as
missing: it is computed anew and replaced. Nothing is unpickled.
"""

import hashlib
import io
import logging
import os
import tempfile
import threading
import time
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

log = logging.getLogger(__name__)

Arrays = Sequence[npt.NDArray[Any]]
FORMAT = "topnav-cache/1"
SUFFIX, PARTIAL = ".npys", ".partial"
SEAL_BYTES = 32  # of a SHA-256
ABANDONED_S = 60.0  # a file still partial after this belongs to a process that was killed


def fingerprint(*parts: object) -> str:
    """Hexadecimal SHA-256 of the `repr` of the parts: strings, numbers and frozen dataclasses of them."""
    digest = hashlib.sha256(FORMAT.encode())
    for part in parts:
        text = repr(part).encode()
        digest.update(len(text).to_bytes(8, "little") + text)
    return digest.hexdigest()


def code_fingerprint(files: Iterable[Path]) -> str:
    """Fingerprint of source files and of the libraries that they draw and compute with."""
    sources = [(path.name, path.read_bytes()) for path in sorted(files)]
    return fingerprint(cv2.__version__, np.__version__, sources)


class DiskCache:
    """Results by key in one folder, which several processes and threads may share."""

    def __init__(self, folder: Path | None, limit_bytes: int) -> None:
        """Use a folder, made when first written to; None keeps nothing."""
        self._folder, self._limit_bytes = folder, limit_bytes
        self._works = folder is not None
        self._lock = threading.Lock()

    @classmethod
    def none(cls) -> "DiskCache":
        """One that keeps nothing."""
        return cls(None, 0)

    def fetch(self, key: str, make: Callable[[], Arrays]) -> list[npt.NDArray[Any]]:
        """Return the arrays kept under a key, or make and keep them.

        Args:
            key: hexadecimal fingerprint of everything that decides the result.
            make: computes the arrays.
        """
        if self._folder is None:
            return list(make())
        path = self._folder / (key + SUFFIX)
        kept = self._read(path, key)
        if kept is not None:
            return kept
        made = list(make())
        if self._works:
            self._write(path, key, made)
        return made

    def tidy(self) -> None:
        """Delete what has gone unused for longest until the rest fits, and what killed processes left."""
        if self._folder is None:
            return
        try:
            ours = [path for path in self._folder.iterdir() if path.suffix in (SUFFIX, PARTIAL)]
            files = [(path.stat(), path) for path in ours]
            total = sum(stat.st_size for stat, _ in files)
            for stat, path in sorted(files, key=lambda item: item[0].st_mtime):
                abandoned = path.suffix == PARTIAL and time.time() - stat.st_mtime > ABANDONED_S
                if abandoned or (total > self._limit_bytes and path.suffix == SUFFIX):
                    path.unlink(missing_ok=True)
                    total -= stat.st_size
        except OSError as error:
            log.debug("cache folder %s was not tidied: %s", self._folder, error)

    def _read(self, path: Path, key: str) -> list[npt.NDArray[Any]] | None:
        try:
            data = path.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            self._give_up(error)
            return None
        content, seal = memoryview(data)[:-SEAL_BYTES], data[-SEAL_BYTES:]
        if _seal(key, content) != seal:
            log.warning("%s is damaged or not ours: computed anew", path)
            return None
        with suppress(OSError):
            os.utime(path)  # tidy() goes by it
        return _arrays(content)

    def _write(self, path: Path, key: str, arrays: Arrays) -> None:
        pieces = _pieces(arrays)
        partial: Path | None = None
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            with tempfile.NamedTemporaryFile(
                dir=path.parent, prefix=path.stem[:16], suffix=PARTIAL, delete=False
            ) as file:
                partial = Path(file.name)
                file.writelines([*pieces, _seal(key, *pieces)])
            partial.replace(path)
        except OSError as error:
            self._give_up(error)
            if partial is not None:
                with suppress(OSError):
                    partial.unlink(missing_ok=True)

    def _give_up(self, error: OSError) -> None:
        """Write no more, and say so once, whichever thread finds out first."""
        with self._lock:
            worked, self._works = self._works, False
        if worked:
            log.warning(
                "cache folder %s cannot be used (%s): what it lacks is computed at every start; "
                "make it writable or choose another one",
                self._folder,
                error.strerror or error,
            )


def _seal(key: str, *pieces: memoryview) -> bytes:
    digest = hashlib.sha256(key.encode())
    for piece in pieces:
        digest.update(piece)
    return digest.digest()


def _pieces(arrays: Arrays) -> list[memoryview]:
    """Header and data of each array, as numpy.save would write them, without copying the data."""
    pieces: list[memoryview] = []
    for array in arrays:
        plain = np.asarray(array, order="C")
        header = io.BytesIO()
        np.lib.format.write_array_header_1_0(header, np.lib.format.header_data_from_array_1_0(plain))
        pieces += [header.getbuffer(), plain.data]
    return pieces


def _arrays(content: memoryview) -> list[npt.NDArray[Any]]:
    stream, arrays = io.BytesIO(content), []
    while stream.tell() < len(content):
        arrays.append(np.lib.format.read_array(stream, allow_pickle=False))
    return arrays
