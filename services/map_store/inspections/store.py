"""Visits to places with their pictures, by map; of each place the newest stay."""

from typing import Any

from pydantic import ValidationError
from sqlalchemy import ColumnElement, Connection, Row, delete, func, insert, select

from services.map_store.errors import InvalidError, MissingError
from services.map_store.integrity.seals import intact, matches, sealed
from services.map_store.storage import catalogue
from services.map_store.storage.blobs import checksum
from services.map_store.storage.database import Database
from services.map_store.storage.tables import inspections
from shared.messages.inspections import Inspection, InspectionReply, InspectionRequest
from shared.messages.places import key_of

BARE = [column for column in inspections.columns if column.name != "content"]
"""A list of rounds reads no pictures."""


class InspectionStore:
    """Visits in `database`. They belong to a map and go with it; they are no part of its history."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def answer(self, name: str, request: InspectionRequest) -> InspectionReply:
        """Do what `request` asks of map `name`; raises MapError."""
        if request.action == "last":
            return InspectionReply(inspection=self.last(name, request))
        visit = request.inspection
        if visit is None or key_of(visit.place) != key_of(request.place):
            raise InvalidError(f"save needs the inspection of {request.place!r}, got another or none")
        self.save(name, visit, request.keep)
        return InspectionReply(inspection=visit.model_copy(update={"picture": b""}))

    def last(self, name: str, request: InspectionRequest) -> Inspection | None:
        """The newest visit that can be read, but for the one that the request is about."""
        table = inspections.c
        another = (table.mission != request.mission_id) | (table.round != request.round)
        return self._newest(name, table.place == key_of(request.place), another)

    def visit_at(self, name: str, place: str, stamp_ns: int) -> Inspection | None:
        """The visit of a place whose picture was taken then; None when it is no longer kept."""
        table = inspections.c
        return self._newest(name, table.place == key_of(place), table.stamp_ns == stamp_ns)

    def visit_in(self, name: str, mission_id: str, number: int, place: str) -> Inspection | None:
        """The visit of a place in a round, with its picture; None when there was none or it is damaged."""
        table = inspections.c
        mine = (table.mission == mission_id, table.round == number)
        return self._newest(name, table.place == key_of(place), *mine)

    def save(self, name: str, visit: Inspection, keep: int) -> None:
        """Keep a visit instead of one of the same place and round; older ones than the last `keep` go."""
        table = inspections.c
        with self._database.write() as connection:
            map_id = catalogue.find(connection, name).map_id
            mine = (table.map_id == map_id, table.place == key_of(visit.place))
            same = (table.mission == visit.mission_id, table.round == visit.round)
            connection.execute(delete(inspections).where(*mine, *same))
            _write(connection, map_id, visit)
            kept = select(table.number).where(*mine).order_by(table.number)
            old = connection.execute(kept).scalars().all()[:-keep]
            connection.execute(delete(inspections).where(table.number.in_(old)))

    def rounds(self, name: str) -> list[list[Inspection]]:
        """All visits that can be read, by round, the newest round first, without their pictures."""
        with self._database.read() as connection:
            map_id = catalogue.find(connection, name).map_id
            query = select(*BARE).where(inspections.c.map_id == map_id).order_by(inspections.c.number)
            rows = connection.execute(query).all()
        by_round: dict[tuple[str, int], list[Inspection]] = {}
        for row in rows:
            if (visit := _facts(row)) is not None:
                by_round.setdefault((visit.mission_id, visit.round), []).append(visit)
        return list(reversed(by_round.values()))

    def round(self, name: str, mission_id: str, number: int) -> list[Inspection]:
        """Visits of one round with their pictures, in their order; MissingError when there are none."""
        table = inspections.c
        with self._database.read() as connection:
            map_id = catalogue.find(connection, name).map_id
            mine = (table.map_id == map_id, table.mission == mission_id, table.round == number)
            rows = connection.execute(select(inspections).where(*mine).order_by(table.number)).all()
        if not rows:
            raise MissingError(f"map {name!r} has no round {mission_id}-{number}; /inspections lists them")
        return [visit for row in rows if (visit := stored_visit(row)) is not None]

    def _newest(self, name: str, *which: ColumnElement[bool]) -> Inspection | None:
        table = inspections.c
        with self._database.read() as connection:
            map_id = catalogue.find(connection, name).map_id
            query = select(inspections).where(table.map_id == map_id, *which).order_by(table.number.desc())
            with connection.execute(query) as rows:
                return next((visit for row in rows if (visit := stored_visit(row)) is not None), None)


def stored_visit(row: Row[Any]) -> Inspection | None:
    """The visit of a row with its picture; None when one of both is damaged."""
    facts = _facts(row)
    if facts is None or not matches(row.content, row.sha256):
        return None
    return facts.model_copy(update={"picture": row.content})


def damaged(connection: Connection) -> list[int]:
    """Numbers of the visits that cannot be read."""
    rows = connection.execute(select(inspections))
    return [row.number for row in rows if stored_visit(row) is None]


def mend(connection: Connection) -> int:
    """Remove the visits that cannot be read; how many there were."""
    bad = damaged(connection)
    connection.execute(delete(inspections).where(inspections.c.number.in_(bad)))
    return len(bad)


def _facts(row: Row[Any]) -> Inspection | None:
    if not intact(inspections, row):
        return None
    try:
        return Inspection.model_validate_json(row.record)
    except ValidationError:
        return None


def _write(connection: Connection, map_id: int, visit: Inspection) -> None:
    newest = connection.execute(select(func.max(inspections.c.number))).scalar() or 0
    values = {
        "number": newest + 1,
        "map_id": map_id,
        "place": key_of(visit.place),
        "mission": visit.mission_id,
        "round": visit.round,
        "stamp_ns": visit.stamp_ns,
        "record": visit.model_copy(update={"picture": b""}).model_dump_json(),
        "sha256": checksum(visit.picture),
    }
    connection.execute(insert(inspections).values({**sealed(inspections, values), "content": visit.picture}))
