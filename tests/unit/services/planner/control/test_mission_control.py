"""The one mission of a robot: a stored one goes on or has failed by name; refusals change nothing."""

import pytest

from services.planner.control.assignment import Assigner
from services.planner.control.mission_control import MissionControl
from services.planner.control.records import MissionRecords
from services.planner.mission_kinds import (
    MissionError,
    MissionKind,
    MissionKinds,
    NoParameters,
    mission_kinds,
)
from services.planner.ports import Decision, Observation, Progress
from services.planner.profiles import DEFAULT
from services.planner.settings import PlannerSettings
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import MapDelta, MapReply, MapRequest, MissionRecord, MissionRecordRequest, Node
from shared.messages.missions import MissionRequest
from shared.messages.sensors import Ranges
from shared.queries import QueryError, RefusedError
from tests.plane_world import picture

RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(1.0,) * 12, max_range_m=4.0)


class Store:
    """A map store with one map of one node and one mission record; no fleet service is there."""

    def watch_alive(self, _changed, _service):
        """Nobody else comes."""

    def __init__(self, record):
        self.record = record
        self.map = record.map
        self.saves, self.away = 0, False
        self.followed = []
        self.revision = 1

    def subscribe(self, _topic, _wake, **names):
        self.followed.append(names["map"])
        return self

    def unsubscribe(self, _inbox):
        self.followed.pop(0)

    def take_all(self):
        """Nobody writes."""
        return []

    def ask(self, _query, request, _timeout_s, **names):
        if isinstance(request, MissionRecordRequest):
            if request.action == "save":
                if self.away:
                    raise QueryError("no answer")
                self.record = request.record
                self.saves += 1
            return self.record
        assert isinstance(request, MapRequest)
        if names["map"] != self.map:
            raise RefusedError(f"no map {names['map']!r}", "missing")
        return MapReply(map=self.map, revision=self.revision, nodes=(Node(node_id=0),))


def mission_control(kinds, store):
    """Of a robot whose missions are of these kinds; all it asks goes to the store."""
    settings = PlannerSettings()
    return MissionControl(Assigner(settings, DEFAULT, kinds, store), MissionRecords(settings, store))


def control_of(gone=False, **record):
    store = Store(MissionRecord(robot="r1", epoch=4, mission_id="m", map="flat", **record))
    store.map = "" if gone else "flat"
    control = mission_control(mission_kinds(), store)
    control.claim()
    return control, store


def test_a_mission_is_gone_on_with_after_a_restart():
    control, _ = control_of(action="explore")
    assert (control.state, control.status().action) == ("running", "explore")
    assert {figure.name for figure in control.status().figures} == {"nodes", "edges", "open_directions"}


def test_a_mission_whose_map_went_while_no_planner_ran_has_failed():
    control, store = control_of(gone=True, action="explore")
    assert (control.state, control.status().failure) == ("failed", "lost")
    assert (store.record.action, store.record.ended_action) == ("", "explore")


@pytest.mark.parametrize("action", ["pause", "cancel"])
def test_a_mission_goes_on_in_its_map_under_another_name(action: str):
    control, store = control_of(action="explore")
    store.map = "house"
    for map_name, renamed_to in (("loft", "attic"), ("flat", "house")):
        control.follow_store(MapDelta(map=map_name, revision=1, reset=True, renamed_to=renamed_to))
    assert (control.state, control.status().map) == ("running", "house")
    control.changes()
    assert store.followed == ["house"]
    control.follow_store(MapDelta(map="house", revision=2, reset=True))
    assert control.handle(MissionRequest(action=action)).map == store.record.map == "house"


def test_a_mission_of_a_kind_that_is_not_known_here_has_failed_and_stays_readable():
    control, store = control_of(action="dance", parameters={"rounds": 2})
    status = control.status()
    assert (status.state, status.action, status.mission_id) == ("failed", "dance", "m")
    assert "unknown mission 'dance', this planner knows explore, goto" in status.reason
    assert (store.record.action, store.record.ended_action) == ("", "dance")


def test_the_end_of_a_mission_of_a_kind_that_is_not_known_here_is_told():
    control, _ = control_of(ended_action="dance", outcome="succeeded", reason="round done")
    assert (control.state, control.status().action, control.status().reason) == (
        "succeeded",
        "dance",
        "round done",
    )


@pytest.mark.parametrize(
    ("request_", "words", "code"),
    [
        (MissionRequest(action="dance", map="flat"), "unknown mission 'dance'", "invalid"),
        (MissionRequest(action="goto", map="flat"), "exactly one of them", "invalid"),
        (MissionRequest(action="goto", map="flat", goal_node=9), "no node 9", "missing"),
        (MissionRequest(action="pause"), "pause needs a mission that is running", "conflict"),
    ],
)
def test_what_cannot_be_followed_is_refused_and_changes_nothing(request_, words, code):
    control, store = control_of(ended_action="explore", outcome="succeeded", reason="done")
    before = control.status()
    with pytest.raises(MissionError, match=words) as refused:
        control.handle(request_)
    assert refused.value.code == code
    assert control.status() == before
    assert store.record.ended_action == "explore"


def test_the_goal_node_of_a_sender_that_knows_no_parameters_counts():
    control, _ = control_of()
    with pytest.raises(MissionError, match="no node 7"):
        control.handle(MissionRequest(action="goto", map="flat", goal_node=7))


class Wait:
    """A mission that does nothing."""

    progress = Progress()


def test_a_mission_learns_where_the_one_before_left_the_robot_in_the_same_map():
    found = []

    def make(context, _parameters):
        found.append(context.whereabouts)
        return Wait()

    kinds = MissionKinds([MissionKind(name="wait", title="Wait", parameters=NoParameters, make=make)])
    store = Store(MissionRecord(robot="r1", epoch=4, mission_id="m", map="flat"))
    control = mission_control(kinds, store)
    control.claim()
    for name in ("flat", "flat", "loft", "flat"):
        store.map = name
        control.handle(MissionRequest(action="wait", map=name))
        control.handle(MissionRequest(action="cancel"))
    first, second, third, last = found
    assert second is first
    assert third is not first
    assert last is not first
    assert [one.map for one in found] == ["flat", "flat", "loft", "flat"]


class Counting(Wait):
    """A mission that counts its frames, two at a time, and can go on counting."""

    def __init__(self, begun):
        self.count = begun

    @property
    def progress(self):
        return Progress(checkpoint={"count": self.count // 2})

    def decide(self, _observation):
        self.count += 1
        return Decision("hold")


def counting_control(store):
    def make(context, _parameters):
        return Counting(2 * int(context.checkpoint.get("count", 0)))

    kinds = MissionKinds([MissionKind(name="count", title="Count", parameters=NoParameters, make=make)])
    control = mission_control(kinds, store)
    control.claim()
    return control


def frames(control, count):
    for seq in range(count):
        control.step(Observation(picture((0.0, 0.0, 0.0), seq), RANGES))


def test_how_far_a_mission_has_got_is_kept_when_it_changes_and_handed_to_the_next_planner():
    store = Store(MissionRecord(robot="r1", epoch=4, mission_id="m", map="flat"))
    control = counting_control(store)
    control.handle(MissionRequest(action="count", map="flat"))
    saved = store.saves
    frames(control, 7)
    assert (store.record.checkpoint, store.saves - saved) == ({"count": 3}, 4)
    frames(counting_control(store), 2)
    assert store.record.checkpoint == {"count": 4}


def test_what_the_store_did_not_take_is_saved_with_the_next_frame():
    store = Store(MissionRecord(robot="r1", epoch=4, mission_id="m", map="flat"))
    control = counting_control(store)
    control.handle(MissionRequest(action="count", map="flat"))
    store.away = True
    with pytest.raises(QueryError):
        frames(control, 1)
    store.away = False
    frames(control, 1)
    assert store.record.checkpoint == {"count": 1}


def test_a_mission_that_ended_leaves_no_checkpoint_to_the_next():
    store = Store(MissionRecord(robot="r1", epoch=4, mission_id="m", map="flat"))
    control = counting_control(store)
    control.handle(MissionRequest(action="count", map="flat"))
    frames(control, 4)
    control.handle(MissionRequest(action="cancel"))
    assert store.record.checkpoint == {}
    control.handle(MissionRequest(action="count", map="flat"))
    frames(control, 2)
    assert store.record.checkpoint == {"count": 1}


def test_a_mission_that_gets_on_may_take_longer_than_one_that_does_not():
    store = Store(MissionRecord(robot="r1", epoch=4, mission_id="m", map="flat"))
    control = counting_control(store)
    control.handle(MissionRequest(action="count", map="flat", max_steps=3))
    frames(control, 20)
    assert control.state == "running"
    control.handle(MissionRequest(action="cancel"))
    control.handle(MissionRequest(action="count", map="flat", max_steps=1))
    frames(control, 2)
    assert (control.state, control.status().failure) == ("failed", "timeout")


def test_who_cannot_begin_in_another_map_hears_of_the_last_one_again():
    control, store = control_of(action="", ended_action="explore", outcome="succeeded")
    with pytest.raises(RefusedError):
        control.handle(MissionRequest(action="goto", mission_id="n", map="loft"))
    assert store.followed == ["loft"]
    control.changes()
    assert store.followed == ["flat"]


def test_who_has_arrived_is_still_somewhere():
    control, _ = control_of(action="explore")
    assert control.status().nearest_node is None
    assert control._assignment is not None
    control._assignment.whereabouts.here = Displacement(7)
    assert control.status().nearest_node == 7
    control.handle(MissionRequest(action="cancel"))
    assert control.status().nearest_node == 7


def test_that_an_earlier_map_of_the_name_was_renamed_is_not_followed():
    control, store = control_of(action="explore")
    store.revision = 3
    control.follow_store(MapDelta(map="flat", revision=1, reset=True, renamed_to="attic"))
    assert control.status().map == "flat"
    assert control.map is not None
    assert control.map.revision == 3


def test_a_map_whose_old_name_another_one_has_already_is_followed():
    control, store = control_of(action="explore")
    assert control.map is not None
    control.map.revision, asked = 9, store.ask
    store.ask = lambda *args, map="", **names: (setattr(store, "map", map), asked(*args, map=map, **names))[1]
    control.follow_store(MapDelta(map="flat", revision=9, reset=True, renamed_to="attic"))
    assert (control.status().map, control.map.revision) == ("attic", 1)
