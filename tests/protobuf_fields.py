"""Protobuf messages without their definitions: the library is no dependency."""

import io
import struct
from typing import Any


def fields(data: bytes) -> dict[int, list[Any]]:
    """The fields of a message by number: integers, doubles, and bytes of all else."""
    found: dict[int, list[Any]] = {}
    stream = io.BytesIO(data)
    while stream.tell() < len(data):
        tag = varint(stream)
        kind = tag & 7
        if kind == 0:
            value: Any = varint(stream)
        elif kind == 1:
            value = struct.unpack("<d", stream.read(8))[0]
        else:
            value = stream.read(varint(stream))
        found.setdefault(tag >> 3, []).append(value)
    return found


def varint(stream: io.BytesIO) -> int:
    """The next integer."""
    value, shift = 0, 0
    while True:
        byte = stream.read(1)[0]
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            return value
