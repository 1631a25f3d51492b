"""Keys of kept results: a hash of everything that decides them, the code and its libraries included."""

import hashlib
from collections.abc import Iterable
from pathlib import Path

import cv2
import numpy as np

FORMAT = "topnav-cache/1"


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
