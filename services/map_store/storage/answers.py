"""Answers to writes asked for over the bus: asked again, one is answered again and not done again.

An asker whose answer is lost, with the network or with the map store that gave it, asks again. So the answer
is kept with the write itself, in one transaction.
"""

from sqlalchemy import Connection, bindparam, delete, func, insert, select

from services.map_store.integrity.seals import intact, sealed
from services.map_store.storage.tables import answers

OF_REQUEST = select(answers).where(
    answers.c.request_id == bindparam("request"), answers.c.map == bindparam("name")
)
NEWEST, INSERT = select(func.max(answers.c.number)), insert(answers)
DELETE_SAME = delete(answers).where(answers.c.request_id == bindparam("request"))
DELETE_OLD = delete(answers).where(answers.c.number <= bindparam("last"))
FORGOTTEN = 100
"""Old answers are removed by so many at a time."""
KEPT = 10_000
"""The newest answers: ten minutes of 16 writes a second, and who asks again does so within seconds."""


def revision_of(connection: Connection, map_name: str, request_id: str) -> int | None:
    """What was answered to this request about this map; None for a new one, and for one without an id."""
    if not request_id:
        return None
    row = connection.execute(OF_REQUEST, {"request": request_id, "name": map_name}).first()
    return row.revision if row is not None and intact(answers, row) else None


def keep(connection: Connection, map_name: str, request_id: str, revision: int) -> None:
    """Remember the answer to a request that has an id, and forget old ones."""
    if not request_id:
        return
    number = (connection.execute(NEWEST).scalar() or 0) + 1
    values = {"number": number, "request_id": request_id, "map": map_name, "revision": revision}
    connection.execute(DELETE_SAME, {"request": request_id})  # it may be damaged
    connection.execute(INSERT, sealed(answers, values))
    if number % FORGOTTEN == 0:
        connection.execute(DELETE_OLD, {"last": number - KEPT})


def damaged(connection: Connection) -> list[int]:
    """Numbers of the rows that do not match their seals."""
    rows = connection.execute(select(answers)).all()
    return [row.number for row in rows if not intact(answers, row)]


def mend(connection: Connection) -> int:
    """Remove damaged rows; how many."""
    numbers = damaged(connection)
    connection.execute(delete(answers).where(answers.c.number.in_(numbers)))
    return len(numbers)
