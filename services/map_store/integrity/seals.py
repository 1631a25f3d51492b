"""A checksum over each small row, kept in the row itself: SQLite does not notice a changed value."""

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

import msgpack
from sqlalchemy import LargeBinary, Row, Table


def seal(table: Table, values: Mapping[Any, Any]) -> str:
    """What the column `seal` of a row with these values must hold.

    Contents are left out: the row holds their own checksum, and a graph is read without them.
    """
    return digest([table.name, *(values[name] for name in _sealed(table))])


def digest(values: Sequence[object]) -> str:
    """Checksum of plain values."""
    return hashlib.sha256(msgpack.packb(values)).hexdigest()


def sealed(table: Table, values: Mapping[str, Any]) -> dict[str, Any]:
    """`values` of a row with their seal."""
    return {**values, "seal": seal(table, values)}


def intact(table: Table, row: Row[Any]) -> bool:
    """Whether a row, read with all sealed columns, says what was written."""
    return bool(row._mapping["seal"] == seal(table, row._mapping))


def matches(data: object, sha256: str) -> bool:
    """Whether `data` are the bytes with this checksum; damage can turn a value into text or a number."""
    return isinstance(data, bytes) and hashlib.sha256(data).hexdigest() == sha256


def _sealed(table: Table) -> list[str]:
    """Columns in alphabetical order: a migration appends where a fresh table has them in between."""
    kept = (c for c in table.columns if c.name != "seal" and not isinstance(c.type, LargeBinary))
    return sorted(column.name for column in kept)
