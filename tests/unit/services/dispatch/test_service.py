"""The dispatch loop against a bus that is none: what it asks, what ends a task, which due times count."""

from typing import Any

import pytest

from services.dispatch.service import Dispatch
from services.dispatch.settings import DispatchSettings
from shared.messages.body import Battery
from shared.messages.drive import Manual
from shared.messages.estop import EStopState
from shared.messages.missions import MissionRequest, MissionStatus
from shared.messages.tasks import Errand, QueueStatus, Schedule, Task, TaskReply, TaskRequest
from shared.queries import QueryError, RefusedError, TimedOutError
from shared.schedules.due_times import NS
from shared.topics import BATTERY, ESTOP_STATE, MANUAL, STATUS

MINUTE = 60 * NS
NOON_NS = 20_000 * 24 * 60 * MINUTE + 12 * 60 * MINUTE


class Inbox:
    """What waits on one topic."""

    def __init__(self) -> None:
        self.waiting: list[Any] = []

    def take_all(self) -> list[Any]:
        taken, self.waiting = self.waiting, []
        return taken


class Bus:
    """Answers for map store and planner, and keeps what it was asked and told."""

    def __init__(self) -> None:
        self.inboxes: dict[Any, Inbox] = {}
        self.tasks: tuple[Task, ...] = ()
        self.schedules: tuple[Schedule, ...] = ()
        self.asked: list[TaskRequest] = []
        self.missions: list[MissionRequest] = []
        self.refusal: Exception | None = None
        self.said: list[QueueStatus] = []
        self.counters, self.counted = self, []

    def count(self, _kind, reason):
        self.counted.append(reason)

    def subscribe(self, topic, robot):
        assert robot == "r1"
        return self.inboxes.setdefault(topic, Inbox())

    def publisher(self, _topic, robot):
        assert robot == "r1"
        return self

    def put(self, status):
        self.said.append(status)

    def ask(self, _query, request, _timeout_s, robot="", queue=""):
        if isinstance(request, MissionRequest):
            self.missions.append(request)
            if self.refusal is not None:
                raise self.refusal
            return MissionStatus(robot=robot)
        if request.action != "read":
            self.asked.append(request)
        assert queue == "r1"
        return TaskReply(robot=queue, tasks=self.tasks, schedules=self.schedules)


class Stage:
    """A dispatch service and what its robot says."""

    def __init__(self) -> None:
        self.bus = Bus()
        self.dispatch = Dispatch(DispatchSettings(), self.bus)

    def hear(self, topic, message):
        self.bus.inboxes[topic].waiting.append(message)

    def free(self, state="idle"):
        """The planner has nothing to do, and the stop is clear."""
        self.hear(STATUS, MissionStatus(robot="r1", state=state))
        self.hear(ESTOP_STATE, EStopState(robot="r1", engaged=False))

    def step(self, now_s=0.0, now_ns=NOON_NS):
        self.dispatch.step(now_s, now_ns)
        return self.bus.said[-1]


@pytest.fixture
def stage():
    return Stage()


def task(**fields):
    return Task(task_id="a", robot="r1", kind="patrol", map="flat", seed=5, max_steps=7, **fields)


def test_a_mission_is_asked_for_with_all_that_the_task_says(stage):
    stage.bus.tasks = (task(attempt=2, checkpoint={"visit": 3}, parameters={"places": ["dock"]}),)
    stage.free()
    assert stage.step().waiting == 1
    (wish,) = stage.bus.missions
    assert (wish.action, wish.map, wish.mission_id, wish.seed, wish.max_steps) == (
        "patrol",
        "flat",
        "a~2",
        5,
        7,
    )
    assert (wish.parameters, wish.checkpoint) == ({"places": ["dock"]}, {"visit": 3})


@pytest.mark.parametrize("code", ["invalid", "missing", "forbidden", "corrupt"])
def test_a_refusal_that_stays_ends_the_task_with_the_planners_words(stage, code):
    stage.bus.tasks, stage.bus.refusal = (task(),), RefusedError("no place 'dock'", code)
    stage.free()
    stage.step()
    (request,) = stage.bus.asked
    assert (request.action, request.task_id, request.reason) == ("refuse", "a", "no place 'dock'")


@pytest.mark.parametrize(
    "error", [RefusedError("busy", "busy"), RefusedError("", "conflict"), TimedOutError("")]
)
def test_any_other_answer_leaves_the_task_waiting(stage, error):
    stage.bus.tasks, stage.bus.refusal = (task(),), error
    stage.free()
    with pytest.raises(QueryError):
        stage.step()
    assert stage.bus.asked == []


def test_what_was_said_long_ago_does_not_count(stage):
    stage.bus.tasks = (task(),)
    stage.free(state="running")
    stage.step(now_s=0.0)
    assert stage.step(now_s=4.0).why == "mission  is running"
    assert stage.step(now_s=6.0).why == "nothing is heard of the planner"
    stage.hear(STATUS, MissionStatus(robot="r1"))
    assert stage.step(now_s=7.0).why == "nothing is heard of drive"


def test_a_person_drives_until_they_let_go_or_are_silent(stage):
    stage.bus.tasks = (task(),)
    stage.hear(MANUAL, Manual(robot="r1", who="anna"))
    stage.free()
    assert stage.step(now_s=0.0).why == "anna drives by hand"
    assert stage.step(now_s=1.0).why == "anna drives by hand"
    stage.hear(MANUAL, Manual(robot="r1", who="anna", action="release"))
    stage.step(now_s=1.1)
    assert len(stage.bus.missions) == 1
    stage.hear(MANUAL, Manual(robot="r1", who="anna"))
    stage.step(now_s=1.2)
    stage.step(now_s=3.3)
    assert len(stage.bus.missions) == 2


def test_a_planner_that_was_replaced_is_not_listened_to(stage):
    stage.bus.tasks = (task(),)
    stage.free()
    stage.hear(STATUS, MissionStatus(robot="r1", epoch=2, state="running", mission_id="m"))
    stage.hear(STATUS, MissionStatus(robot="r1", epoch=1, state="idle"))
    assert stage.step().why == "mission m is running"


def test_a_low_battery_is_told_to_the_map_store(stage):
    stage.bus.tasks = (task(),)
    stage.free()
    stage.hear(BATTERY, Battery(robot="r1", share=0.1))
    stage.step()
    (request,) = stage.bus.asked
    assert (request.action, request.task.kind, request.task.map) == ("go_home", "home", "flat")


@pytest.mark.parametrize(
    ("handled_min_ago", "expected"),
    [
        (0, []),
        (1, [(0, False)]),
        (3, [(-1, True), (0, False)]),
    ],
    ids=["handled", "due", "one of three"],
)
def test_of_the_due_times_since_the_last_the_newest_makes_a_task(stage, handled_min_ago, expected):
    stage.bus.schedules = (every_minute(handled_ns=NOON_NS - handled_min_ago * MINUTE),)
    stage.step(now_ns=NOON_NS + 5 * NS)
    found = [(request.due_ns - NOON_NS, request.skip) for request in stage.bus.asked]
    assert found == expected
    assert all((r.action, r.name) == ("make_due", "often") for r in stage.bus.asked)


def test_a_time_that_is_too_old_is_skipped_and_one_of_a_schedule_that_is_off_is_left(stage):
    old = every_minute(cron="0 11 * * *", handled_ns=NOON_NS - 120 * MINUTE)
    stage.bus.schedules = (old, old.model_copy(update={"name": "off", "enabled": False}))
    stage.step()
    (request,) = stage.bus.asked
    assert (request.name, request.due_ns, request.skip) == ("often", NOON_NS, True)


def test_a_schedule_that_cannot_be_read_keeps_nothing_else(stage):
    stage.bus.schedules = (every_minute(cron="61 * * * *"),)
    stage.bus.tasks = (task(),)
    stage.free()
    stage.step()
    assert "often: field minute" in stage.bus.counted[0]
    assert len(stage.bus.missions) == 1


def every_minute(**changes):
    schedule = Schedule(name="often", robot="r1", cron="* * * * *", task=Errand(kind="patrol"))
    return schedule.model_copy(update=changes)
