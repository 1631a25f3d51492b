"""Schedules: one due time makes one task at most, whoever asks and however often."""

import pytest

from services.map_store.errors import ConflictError, MissingError
from services.map_store.storage.database import Database
from services.map_store.tasks import timetable
from services.map_store.tasks.queue import TaskStore
from shared.messages.tasks import Errand, Schedule, Task, TaskReply, TaskRequest

S = 1_000_000_000
NOW_NS = 1_000 * S


class Times:
    """A store of tasks whose clock is set by hand."""

    def __init__(self, database: Database) -> None:
        self.now_ns = NOW_NS
        self._store = TaskStore(database, lambda: self.now_ns)

    def ask(self, action: str, **fields: object) -> TaskReply:
        return self._store.answer("r1", TaskRequest.model_validate({"action": action, **fields}))

    def put(self, **changes: object) -> Schedule:
        errand = Errand(kind="wave", map="flat", priority=6)
        schedule = Schedule(name="night", robot="r1", cron="0 22 * * *", task=errand)
        return self.ask("put_schedule", schedule=schedule.model_copy(update=changes)).schedules[0]

    def due(self, at_s: int, **fields: object) -> Task | None:
        return self.ask("make_due", name="night", due_ns=at_s * S, **fields).task


@pytest.fixture
def times(database: Database) -> Times:
    return Times(database)


def test_a_due_time_makes_one_task_however_often_it_is_asked_for(times: Times):
    times.put()
    task = times.due(1_100)
    assert (task.task_id, task.schedule, task.priority, task.due_ns) == ("night-1100", "night", 6, 1_100 * S)
    assert times.due(1_100) is None
    assert times.due(1_099) is None
    assert [task.task_id for task in times.ask("read").tasks] == ["night-1100"]


def test_times_from_before_a_schedule_was_set_make_none(times: Times):
    times.put()
    assert times.due(1_000) is None
    assert times.due(1_001) is not None


@pytest.mark.parametrize(
    ("changes", "forgets"),
    [
        ({"task": Errand(kind="explore")}, False),
        ({"cron": "0 23 * * *"}, True),
        ({"time_zone": "Europe/Zurich"}, True),
        ({"enabled": False}, True),
    ],
    ids=["task", "cron", "time zone", "enabled"],
)
def test_a_changed_schedule_begins_anew_only_where_its_times_changed(times: Times, changes, forgets):
    times.put()
    times.due(1_100)
    times.now_ns = 2_000 * S
    assert times.put(**changes).handled_ns == (2_000 if forgets else 1_100) * S


def test_a_schedule_that_is_off_makes_none_and_catches_nothing_up_when_it_is_on_again(times: Times):
    times.put(enabled=False)
    assert times.due(1_100) is None
    times.now_ns = 1_200 * S
    times.put()
    assert times.due(1_100) is None


def test_a_skipped_time_is_counted_and_handled(times: Times):
    times.put()
    assert times.due(1_100, skip=True, reason="the robot was off") is None
    assert times.due(1_100) is None
    (schedule,) = times.ask("read").schedules
    assert (schedule.skipped, schedule.skipped_ns, schedule.handled_ns) == (1, NOW_NS, 1_100 * S)


def test_while_a_task_of_an_earlier_time_waits_no_other_is_made(times: Times):
    times.put()
    times.due(1_100)
    assert times.due(1_200) is None
    assert times.ask("read").schedules[0].skipped == 1
    times.ask("cancel", task_id="night-1100")
    assert times.due(1_300) is not None


def test_a_schedule_removed_and_set_again_does_not_make_the_same_task_twice(times: Times):
    times.put()
    times.due(1_100)
    times.ask("cancel", task_id="night-1100")
    times.ask("remove_schedule", name="night")
    times.put()
    assert times.due(1_100) is None
    assert times.ask("read").tasks == ()


def test_a_schedule_that_is_not_there_or_one_too_many_is_refused(
    times: Times, monkeypatch: pytest.MonkeyPatch
):
    with pytest.raises(MissingError, match="r1 has no schedule 'night'"):
        times.due(1_100)
    with pytest.raises(MissingError):
        times.ask("remove_schedule", name="night")
    monkeypatch.setattr(timetable, "MOST", 0)
    with pytest.raises(ConflictError, match="has 0 schedules"):
        times.put()
