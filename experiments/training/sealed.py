"""Files with the beginning of their checksum in their name: what was cut off or changed is seen and named."""

import hashlib
import io
import json
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from numpy.lib.npyio import NpzFile

from services.launcher.client.failure import ExperimentError

DIGITS = 16
"""Of the SHA-256, hexadecimal: chance takes a changed file for whole once in 10^19."""

_PARSING = threading.Lock()
"""Threads read shards side by side, and numpy parses the header of an array as a Python literal: in CPython
before 3.11.5 (Debian 12 has 3.11.2) two threads that do so at once end in a SystemError."""


def write_sealed(folder: Path, stem: str, suffix: str, data: bytes) -> Path:
    """Write `folder`/`stem`-CHECKSUM`suffix` in one step, and take away what had the same stem."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{stem}-{_seal(data)}{suffix}"
    new = path.with_name(path.name + ".new")
    new.write_bytes(data)
    new.replace(path)
    for other in sealed_files(folder, stem, suffix):
        if other != path:
            other.unlink()
    return path


def sealed_files(folder: Path, stem: str, suffix: str) -> list[Path]:
    """Files of a stem, which may hold wildcards, by name."""
    return sorted(folder.glob(f"{stem}-{'[0-9a-f]' * DIGITS}{suffix}"))


def read_sealed(path: Path, what: str, remedy: str) -> bytes:
    """The contents.

    Args:
        path: of a file that `write_sealed` wrote.
        what: it is, for the message.
        remedy: what to do about a broken one, for the message.

    Raises:
        ExperimentError: it is not there, or not what was written.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise ExperimentError(f"{what} {path} cannot be read ({error.strerror}): {remedy}") from error
    wanted, found = path.name.removesuffix(path.suffix)[-DIGITS:], _seal(data)
    if found != wanted:
        raise ExperimentError(
            f"{what} {path} is corrupted: its name promises checksum {wanted}, its {len(data)} bytes "
            f"have {found}: {remedy}"
        )
    return data


def packed(arrays: Mapping[str, Any], about: Mapping[str, Any]) -> bytes:
    """Arrays and a description (JSON) as one compressed file of numpy."""
    stream = io.BytesIO()
    text = np.frombuffer(json.dumps(about, sort_keys=True).encode(), np.uint8)
    np.savez_compressed(stream, **{**arrays, "about": text})
    return stream.getvalue()


def unpacked(data: bytes) -> dict[str, npt.NDArray[Any]]:
    """The arrays that `packed` put in."""
    with np.load(io.BytesIO(data), allow_pickle=False) as kept:
        return {name: _array(kept, name) for name in kept.files if name != "about"}


def computed_once(
    folder: Path, stem: str, make: Callable[[], dict[str, npt.NDArray[Any]]]
) -> dict[str, npt.NDArray[Any]]:
    """Arrays that take minutes to compute: those that an earlier run kept in a folder, or new ones, kept.

    Raises:
        ExperimentError: what was kept is not what was written.
    """
    for path in sealed_files(folder, stem, ".npz"):
        return unpacked(read_sealed(path, stem, "delete it, which computes it again"))
    made = make()
    write_sealed(folder, stem, ".npz", packed(made, {}))
    return made


def description(data: bytes) -> dict[str, Any]:
    """The description that `packed` put in; the arrays stay packed."""
    with np.load(io.BytesIO(data), allow_pickle=False) as kept:
        about: dict[str, Any] = json.loads(_array(kept, "about").tobytes())
    return about


def _array(kept: NpzFile, name: str) -> npt.NDArray[Any]:
    assert kept.zip is not None, "it is open"
    packed_array = kept.zip.read(f"{name}.npy")
    with _PARSING:
        array: npt.NDArray[Any] = np.lib.format.read_array(io.BytesIO(packed_array), allow_pickle=False)
    return array


def _seal(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:DIGITS]
