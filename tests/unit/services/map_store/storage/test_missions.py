"""Mission records: claims shut older planners out, damaged records never give an epoch back."""

import numpy as np
import pytest
from sqlalchemy import update

from services.map_store.errors import ConflictError, InvalidError
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.storage.tables import missions
from shared.messages.features import Features
from shared.messages.maps import MissionRecord


def test_a_claim_without_a_record_gives_an_empty_one_with_epoch_one(database: Database):
    record = MissionStore(database).claim("r1")
    assert (record.robot, record.epoch, record.action) == ("r1", 1, "")


def test_a_claim_gives_what_was_saved_with_the_next_epoch(database: Database):
    store = MissionStore(database)
    goal = Features(
        pipeline="sift",
        lonlat_rad=np.ones((1, 2), np.float32),
        scores=np.ones(1, np.float32),
        descriptors=np.ones((1, 8), np.float32),
    )
    claimed = store.claim("r1")
    saved = claimed.model_copy(update={"mission_id": "m-1", "action": "goto", "goal": goal, "step": 9})
    store.save(saved)
    restored = MissionStore(database).claim("r1")
    assert restored.model_dump() == saved.model_dump() | {"epoch": 2}
    assert store.claim("r1").epoch == 3


def test_a_planner_that_was_replaced_cannot_save(database: Database):
    store = MissionStore(database)
    old = store.claim("r1")
    store.claim("r1")
    with pytest.raises(ConflictError, match="epoch 1 is over, 2 has begun"):
        store.save(old)


def test_robots_do_not_share_epochs(database: Database):
    store = MissionStore(database)
    store.claim("r1")
    assert store.claim("r2").epoch == 1


def test_a_damaged_record_is_lost_but_its_epoch_is_not(database: Database):
    store = MissionStore(database)
    store.save(MissionRecord(robot="r1", epoch=7, action="explore"))
    with database.write() as connection:
        connection.execute(update(missions).values(content=b"junk"))
    record = store.claim("r1")
    assert (record.epoch, record.action) == (8, "")


@pytest.mark.parametrize(
    "record",
    [
        MissionRecord.model_construct(robot="../r"),
        MissionRecord(robot="maps"),
        MissionRecord(robot="r", epoch=2**63),
    ],
)
def test_records_that_cannot_be_kept_are_refused(database: Database, record: MissionRecord):
    with pytest.raises(InvalidError):
        MissionStore(database).save(record)
