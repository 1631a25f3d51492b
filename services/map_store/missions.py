"""Mission records, one per robot: what a restarted planner goes on with, and which planner is the newest."""

from sqlalchemy import Connection, delete, insert, select

from services.map_store.blobs import checksum
from services.map_store.database import Database
from services.map_store.errors import ConflictError, InvalidError
from services.map_store.tables import missions
from shared.messages.maps import MissionRecord
from shared.topics import MISSION_RECORD, NAME
from shared.wire import WireError, decode, encode

MAX_EPOCH = 2**62


class MissionStore:
    """Records by robot in `database`."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def claim(self, robot: str) -> MissionRecord:
        """A planner starts: give it the record with the next epoch, which shuts its predecessors out."""
        _check_robot(robot)
        with self._database.write() as connection:
            stored = self._read(connection, robot)
            record = stored.model_copy(update={"epoch": stored.epoch + 1})
            self._write(connection, record)
        return record

    def save(self, record: MissionRecord) -> MissionRecord:
        """Keep `record`; ConflictError when a planner with a later epoch has taken over."""
        _check_robot(record.robot)
        if record.epoch > MAX_EPOCH:
            raise InvalidError(f"epoch must be at most {MAX_EPOCH}, got {record.epoch}")
        with self._database.write() as connection:
            stored = self._read(connection, record.robot)
            if record.epoch < stored.epoch:
                raise ConflictError(
                    f"robot {record.robot!r}: epoch {record.epoch} is over, {stored.epoch} has begun; stop"
                )
            self._write(connection, record)
        return record

    @staticmethod
    def _read(connection: Connection, robot: str) -> MissionRecord:
        row = connection.execute(select(missions).where(missions.c.robot == robot)).first()
        if row is None:
            return MissionRecord(robot=robot)
        try:
            if checksum(row.content) == row.sha256:
                return decode(MissionRecord, row.content, MISSION_RECORD.max_bytes)
        except WireError:
            pass
        # The mission is lost; the epoch must not be, or an old planner could take the robot back.
        return MissionRecord(robot=robot, epoch=row.epoch)

    @staticmethod
    def _write(connection: Connection, record: MissionRecord) -> None:
        content = encode(record)
        row = {"robot": record.robot, "epoch": record.epoch, "content": content, "sha256": checksum(content)}
        connection.execute(delete(missions).where(missions.c.robot == record.robot))
        connection.execute(insert(missions).values(row))


def _check_robot(robot: str) -> None:
    if not NAME.match(robot):
        raise InvalidError(f"robot name must match [a-z0-9_-]{{1,64}}, got {robot[:80]!r}")
