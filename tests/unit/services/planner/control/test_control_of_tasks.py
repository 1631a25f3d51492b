"""Missions of tasks: controls for the one that is named, who paused it, what cannot be saved."""

import pytest
from pydantic import BaseModel, ConfigDict

from services.planner.mission_kinds import MissionError, MissionKind, MissionKinds, NoParameters
from services.planner.ports import Progress
from shared.messages.maps import MissionRecord
from shared.messages.missions import MissionRequest
from shared.queries import QueryError, RefusedError
from tests.unit.services.planner.control.test_mission_control import Store, mission_control


class Point(BaseModel):
    """The checkpoint of the mission below."""

    model_config = ConfigDict(extra="forbid")

    visit: int = 0


class Stand:
    """Does nothing, from a checkpoint on."""

    def __init__(self, point: Point) -> None:
        self.progress = Progress(checkpoint=point.model_dump())


KIND = MissionKind("stand", "Stand", NoParameters, lambda c, _: Stand(Point.model_validate(c.checkpoint)))


class Refusing(Store):
    """A store that can refuse what is to be kept."""

    why = ""

    def ask(self, query, request, timeout_s, **names):
        if self.why and getattr(request, "action", "") == "save":
            raise RefusedError(self.why, "conflict")
        return super().ask(query, request, timeout_s, **names)


@pytest.fixture
def store():
    return Refusing(MissionRecord(robot="r1", epoch=4, map="flat"))


@pytest.fixture
def control(store):
    made = mission_control(MissionKinds([KIND]), store)
    made.claim()
    return made


def start(control, mission_id="one", **fields):
    return control.handle(MissionRequest(action="stand", map="flat", mission_id=mission_id, **fields))


def test_a_control_is_for_the_mission_that_it_names_or_for_any(control):
    start(control)
    with pytest.raises(MissionError, match="mission other is not the one of now, that is 'one'") as caught:
        control.handle(MissionRequest(action="cancel", mission_id="other"))
    assert (caught.value.code, control.state) == ("conflict", "running")
    assert control.handle(MissionRequest(action="pause", mission_id="one")).state == "paused"
    assert control.handle(MissionRequest(action="cancel")).state == "cancelled"


def test_who_paused_a_mission_is_told_and_kept(control, store):
    start(control)
    control.pause("emergency stop: a child", "emergency_stop")
    assert (control.status().paused_by, store.record.paused_by) == ("emergency_stop", "emergency_stop")
    again = mission_control(MissionKinds([KIND]), store)
    again.claim()
    assert (again.state, again.status().paused_by) == ("paused", "emergency_stop")
    assert again.handle(MissionRequest(action="resume")).paused_by == ""
    assert (store.record.paused, store.record.paused_by) == (False, "")


@pytest.mark.parametrize("by", ["person", "by_hand"])
def test_only_what_the_emergency_stop_paused_can_be_paused_by_a_person_as_well(control, by):
    start(control)
    control.pause("emergency stop", "emergency_stop")
    assert control.handle(MissionRequest(action="pause")).paused_by == "person"
    control.handle(MissionRequest(action="resume"))
    control.pause("somebody", by)
    with pytest.raises(MissionError, match="pause needs a mission that is running"):
        control.handle(MissionRequest(action="pause"))


def test_a_mission_begins_from_the_checkpoint_that_comes_with_it(control, store):
    start(control, checkpoint={"visit": 3})
    assert store.record.checkpoint == {"visit": 3}
    assert control.handle(MissionRequest(action="status")).state == "running"


def test_a_checkpoint_of_another_program_is_refused_by_name(control):
    with pytest.raises(MissionError, match=r"stand cannot go on from \{'lap': 3\}"):
        start(control, checkpoint={"lap": 3})
    assert control.state == "idle"


def test_a_start_that_the_store_refuses_leaves_everything_as_it_was(control, store):
    start(control)
    control.handle(MissionRequest(action="cancel"))
    before = control.status()
    store.why = "task 'two' is over"
    with pytest.raises(RefusedError):
        start(control, "two")
    assert control.status() == before


def test_an_end_that_could_not_be_saved_is_saved_before_anything_else(control, store):
    start(control)
    store.away = True
    with pytest.raises(QueryError):
        control.handle(MissionRequest(action="cancel"))
    assert (control.state, store.record.outcome) == ("cancelled", "")
    with pytest.raises(QueryError):
        start(control, "two")
    assert control.state == "cancelled"
    store.away = False
    saves = store.saves
    control.settle()
    assert (store.record.mission_id, store.record.outcome, store.saves) == ("one", "cancelled", saves + 1)
    control.settle()
    assert store.saves == saves + 1, "once is enough"


def test_the_end_of_a_mission_is_on_record_before_the_next_begins(control, store):
    start(control)
    store.away = True
    with pytest.raises(QueryError):
        control.handle(MissionRequest(action="cancel"))
    store.away, saves = False, store.saves
    start(control, "two")
    assert (store.record.mission_id, store.saves) == ("two", saves + 2)
