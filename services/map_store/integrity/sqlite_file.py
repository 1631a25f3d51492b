"""What only SQLite can be asked: whether its file is sound, and what its tables look like."""

from sqlalchemy import Connection


def damage(connection: Connection) -> tuple[str, ...]:
    """Read the whole file; what is wrong with its trees, indexes and free pages."""
    lines = connection.exec_driver_sql("PRAGMA integrity_check").scalars().all()
    if list(lines) == ["ok"]:
        return ()
    return tuple(" ".join(str(line).removeprefix("*** in database main ***").split()) for line in lines)


def dangling(connection: Connection) -> tuple[str, ...]:
    """Rows that refer to a row that is not there."""
    rows = connection.exec_driver_sql("PRAGMA foreign_key_check").all()
    return tuple(f"row {row[1]} of {row[0]} refers to a row of {row[2]} that is not there" for row in rows)


def description(connection: Connection) -> list[tuple[str, ...]]:
    """Every table and index in SQL, as the file describes them."""
    query = "SELECT type, name, tbl_name, coalesce(sql, '') FROM sqlite_master ORDER BY type, name"
    return [tuple(row) for row in connection.exec_driver_sql(query)]


def rebuild_indexes(connection: Connection) -> None:
    """Write every index anew from its table."""
    connection.exec_driver_sql("REINDEX")
