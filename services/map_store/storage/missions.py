"""Mission records, one per robot: what a restarted planner goes on with, and which planner is the newest.

With a record the robot's tasks are written that it is about, see `services.map_store.tasks.following`.
"""

import logging
import time
from collections.abc import Callable
from typing import Any

from sqlalchemy import Connection, Row, delete, insert, select

from services.map_store.errors import ConflictError, InvalidError
from services.map_store.integrity.seals import intact, matches, sealed
from services.map_store.storage.blobs import checksum
from services.map_store.storage.database import Database
from services.map_store.storage.tables import missions
from services.map_store.tasks.following import follow, give_up_lost
from shared.messages.maps import MissionRecord
from shared.topics import MISSION_RECORD
from shared.transport.keys import check_robot
from shared.wire import WireError, decode, encode

log = logging.getLogger(__name__)

MAX_EPOCH = 2**62
"""A database integer holds twice as much: there is always a next epoch."""


class MissionStore:
    """Records by robot in `database`; `now_ns` is a clock, nanoseconds since the Unix epoch."""

    def __init__(self, database: Database, now_ns: Callable[[], int] = time.time_ns) -> None:
        self._database, self._now_ns = database, now_ns

    def claim(self, robot: str) -> MissionRecord:
        """A planner starts: give it the record with the next epoch, which shuts its predecessors out."""
        _check_robot(robot)
        with self._database.write() as connection:
            stored = self._read(connection, robot)
            record = stored.model_copy(update={"epoch": stored.epoch + 1})
            give_up_lost(connection, record, self._now_ns())
            _write(connection, record)
        return record

    def save(self, record: MissionRecord) -> MissionRecord:
        """Keep `record`, and what it says of a task.

        Raises:
            ConflictError: a planner with a later epoch has taken over, or the task is over.
        """
        _check_robot(record.robot)
        if record.epoch > MAX_EPOCH:
            raise InvalidError(f"epoch must be at most {MAX_EPOCH}, got {record.epoch}")
        with self._database.write() as connection:
            stored = self._read(connection, record.robot)
            if record.epoch < stored.epoch:
                raise ConflictError(
                    f"robot {record.robot!r}: epoch {record.epoch} is over, {stored.epoch} has begun; stop"
                )
            follow(connection, stored, record, self._now_ns())
            _write(connection, record)
        return record

    @staticmethod
    def _read(connection: Connection, robot: str) -> MissionRecord:
        row = connection.execute(select(missions).where(missions.c.robot == robot)).first()
        if row is None:
            return MissionRecord(robot=robot)
        record = stored_record(row)
        if record is None or record.robot != robot:
            # The mission is lost; the epoch must not be, or an old planner could take the robot back.
            log.error(
                "robot %s: the record of its mission is damaged, only epoch %d is kept", robot, row.epoch
            )
            return MissionRecord(robot=robot, epoch=row.epoch)
        return record


def follow_rename(connection: Connection, name: str, new_name: str) -> None:
    """Have the missions in a map be missions in the map of its new name: a planner may be away just now."""
    for row in connection.execute(select(missions)).all():
        record = stored_record(row)
        if record is not None and record.map == name:
            _write(connection, record.model_copy(update={"map": new_name}))


def sound(row: Row[Any]) -> bool:
    """Whether a row and the record in it say what was written."""
    record = stored_record(row)
    named = record is not None and (record.robot, record.epoch) == (row.robot, row.epoch)
    return named and intact(missions, row)


def mend_missions(connection: Connection) -> int:
    """Write damaged rows anew, from the record or, where that is lost, with the epoch alone; how many."""
    rows = connection.execute(select(missions)).all()
    bad = sum(not sound(row) for row in rows)
    if bad:
        connection.execute(delete(missions))
        for row in rows:
            known = MissionRecord(robot=row.robot, epoch=row.epoch) if intact(missions, row) else None
            record = stored_record(row) or known
            if record is not None:
                _write(connection, record)
    return bad


def stored_record(row: Row[Any]) -> MissionRecord | None:
    """The record of a row; None when its bytes are damaged."""
    if not matches(row.content, row.sha256):
        return None
    try:
        return decode(MissionRecord, row.content, MISSION_RECORD.max_bytes)
    except WireError:
        return None


def _write(connection: Connection, record: MissionRecord) -> None:
    content = encode(record)
    values = {"robot": record.robot, "epoch": record.epoch, "sha256": checksum(content)}
    row = {**sealed(missions, values), "content": content}
    connection.execute(delete(missions).where(missions.c.robot == record.robot))
    connection.execute(insert(missions).values(row))


def _check_robot(robot: str) -> None:
    try:
        check_robot(robot)
    except ValueError as error:
        raise InvalidError(str(error)) from None
