"""The queue: order, what may be changed when, and tasks that follow the records of missions exactly once."""

from itertools import count

import pytest
from sqlalchemy import update

from services.map_store.errors import ConflictError, InvalidError, MissingError
from services.map_store.integrity.check import check
from services.map_store.storage import tables
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from services.map_store.tasks import following
from services.map_store.tasks.queue import WAITING, TaskStore
from shared.messages.maps import MissionRecord
from shared.messages.tasks import Task, TaskReply, TaskRequest


class Desk:
    """A store of tasks, the records of missions beside it, and a clock that ticks."""

    def __init__(self, database: Database) -> None:
        ticks = count(1_000_000_000, 1_000_000_000)
        self.tasks = TaskStore(database, lambda: next(ticks))
        self.missions = MissionStore(database, lambda: next(ticks))
        self.missions.claim("r1")

    def ask(self, action: str, **fields: object) -> TaskReply:
        return self.tasks.answer("r1", TaskRequest.model_validate({"action": action, **fields}))

    def add(self, task_id: str, **fields: object) -> TaskReply:
        task = Task(task_id=task_id, robot="r1", kind="wave", map="flat", **fields)
        return self.ask("add", task=task)

    def begin(self, mission_id: str, **fields: object) -> None:
        """What a planner saves while a mission runs."""
        record = MissionRecord(
            robot="r1", epoch=1, mission_id=mission_id, action="wave", map="flat", **fields
        )
        self.missions.save(record)

    def end(self, mission_id: str, outcome: str = "succeeded", **fields: object) -> None:
        """What a planner saves when a mission has ended."""
        how = {"ended_action": "wave", "outcome": outcome, **fields}
        self.missions.save(MissionRecord(robot="r1", epoch=1, mission_id=mission_id, **how))

    def states(self) -> dict[str, str]:
        reply = self.ask("read", ended=200)
        return {task.task_id: task.state for task in (*reply.tasks, *reply.ended)}

    def task(self, task_id: str) -> Task:
        task = self.ask("read", task_id=task_id).task
        assert task is not None
        return task


@pytest.fixture
def desk(database: Database) -> Desk:
    return Desk(database)


def test_tasks_wait_by_priority_then_age_and_what_runs_is_first(desk: Desk):
    for task_id, priority in (("a", 4), ("b", 9), ("c", 4), ("d", 0)):
        desk.add(task_id, priority=priority)
    assert [task.task_id for task in desk.ask("read").tasks] == ["b", "a", "c", "d"]
    desk.ask("prioritize", task_id="c", priority=5)
    desk.begin("d")
    assert [task.task_id for task in desk.ask("read").tasks] == ["d", "b", "c", "a"]


def test_a_task_runs_when_its_mission_is_on_record_and_ends_with_it(desk: Desk):
    desk.add("a")
    desk.begin("a")
    desk.begin("a", checkpoint={"visit": 1})
    assert desk.states() == {"a": "running"}
    desk.end("a", "failed", failure="lost", reason="no node looks like this")
    task = desk.task("a")
    assert (task.state, task.failure, task.reason) == ("failed", "lost", "no node looks like this")
    assert 0 < task.created_ns < task.started_ns < task.ended_ns


def test_a_task_that_is_over_is_not_begun_again_and_the_record_stays(desk: Desk):
    desk.add("a")
    desk.begin("a")
    desk.end("a")
    with pytest.raises(ConflictError, match="task 'a' is over \\(succeeded\\)"):
        desk.begin("a")
    assert desk.missions.claim("r1").outcome == "succeeded"


def test_an_end_that_is_saved_twice_is_one(desk: Desk):
    desk.add("a")
    desk.begin("a")
    desk.end("a")
    ended_ns = desk.task("a").ended_ns
    desk.end("a", "failed")
    assert (desk.task("a").state, desk.task("a").ended_ns) == ("succeeded", ended_ns)


def test_a_task_that_was_cancelled_while_it_waited_is_not_begun(desk: Desk):
    desk.add("a")
    desk.ask("cancel", task_id="a")
    desk.ask("cancel", task_id="a")
    with pytest.raises(ConflictError):
        desk.begin("a")
    assert desk.states() == {"a": "cancelled"}


def test_a_task_that_runs_cannot_be_refused_or_moved_and_is_not_cancelled_without_its_mission(desk: Desk):
    desk.add("a")
    desk.begin("a")
    assert desk.ask("cancel", task_id="a").task.state == "running"
    assert desk.ask("refuse", task_id="a", reason="no").task.state == "running"
    with pytest.raises(ConflictError, match="runs already"):
        desk.ask("prioritize", task_id="a", priority=9)
    desk.end("a", "cancelled")
    with pytest.raises(ConflictError, match="is over"):
        desk.ask("prioritize", task_id="a", priority=9)


def test_a_task_is_added_once_however_often_it_is_sent(desk: Desk):
    for _ in range(2):
        desk.add("a")
    assert desk.states() == {"a": "queued"}
    desk.begin("a")
    desk.end("a")
    assert desk.add("a").task.state == "succeeded"
    with pytest.raises(ConflictError, match="another task 'a'"):
        desk.add("a", parameters={"frames": 3})


def test_a_refused_task_has_failed_with_the_planners_reason(desk: Desk):
    desk.add("a")
    task = desk.ask("refuse", task_id="a", reason="the map has no place 'dock'").task
    assert (task.state, task.failure, task.reason) == ("failed", "refused", "the map has no place 'dock'")
    assert desk.ask("read").latest == task


def test_what_is_not_there_or_too_much_is_said(desk: Desk, monkeypatch: pytest.MonkeyPatch):
    with pytest.raises(MissingError, match="r1 has no task 'x'"):
        desk.ask("cancel", task_id="x")
    with pytest.raises(InvalidError, match="a task expected"):
        desk.ask("add")
    with pytest.raises(InvalidError, match="parameters of a task"):
        desk.add("a", parameters={"places": ["x" * 60] * 300})
    with pytest.raises(InvalidError, match="name"):
        desk.tasks.answer("maps", TaskRequest(action="read"))
    monkeypatch.setattr("services.map_store.tasks.queue.WAITING", 2)
    desk.add("a")
    desk.add("b")
    with pytest.raises(ConflictError, match="2 tasks wait for r1"):
        desk.add("c")
    assert WAITING > 2


def test_low_battery_puts_the_running_task_back_with_what_it_has_done_behind_the_way_home(desk: Desk):
    desk.add("a")
    desk.add("b", priority=9)
    desk.begin("a", checkpoint={"visit": 3})
    home = Task(task_id="home", robot="r1", kind="home", map="flat", priority=9)
    for _ in range(2):
        assert desk.ask("go_home", task=home).task.for_battery
    desk.end("a", "cancelled")
    queue = desk.ask("read").tasks
    assert [task.kind for task in queue] == ["home", "wave", "wave"]
    assert [task.task_id for task in queue[1:]] == ["b", "a"]
    assert (queue[2].checkpoint, queue[2].mission_id) == ({"visit": 3}, "a~1")
    desk.begin(queue[0].task_id)
    desk.end(queue[0].task_id)
    assert desk.ask("read").latest.for_battery
    with pytest.raises(ConflictError, match="mission 'a' is over: task 'a' is queued again"):
        desk.begin("a")
    desk.begin("a~1")
    desk.end("a~1")
    assert not desk.ask("read").latest.for_battery
    assert desk.task("a").state == "succeeded"


def test_a_task_that_was_to_be_put_back_ends_where_its_mission_did_or_a_person_cancels_it(desk: Desk):
    home = Task(task_id="home", robot="r1", kind="home", map="flat")
    for task_id, outcome in (("a", "succeeded"), ("b", "cancelled")):
        desk.add(task_id)
        desk.begin(task_id)
        desk.ask("go_home", task=home)
        if outcome == "cancelled":
            desk.ask("cancel", task_id=task_id)
        desk.end(task_id, outcome)
        assert desk.task(task_id).state == outcome


def test_a_running_task_whose_mission_is_lost_fails_and_one_to_be_put_back_waits(desk: Desk, database):
    desk.add("a")
    desk.begin("a")
    with database.write() as connection:
        connection.execute(update(tables.missions).values(content=b"junk"))
    desk.missions.claim("r1")
    assert (desk.task("a").state, desk.task("a").failure) == ("failed", "service_lost")


def test_the_oldest_that_ended_are_forgotten(desk: Desk, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(following, "KEPT", 2)
    for task_id in ("a", "b", "c"):
        desk.add(task_id)
        desk.begin(task_id)
        desk.end(task_id)
    assert [task.task_id for task in desk.ask("read", ended=9).ended] == ["c", "b"]


def test_tasks_and_schedules_follow_a_map_to_its_new_name(desk: Desk, store: MapStore):
    desk.tasks = TaskStore(store.database, lambda: 5)
    desk.add("a")
    store.rename("flat", "house")
    assert desk.task("a").map == "house"


def test_a_damaged_task_is_counted_found_and_removed_by_a_repair(desk: Desk, store: MapStore):
    desk.add("a")
    desk.add("b")
    with store.database.write() as connection:
        connection.execute(update(tables.tasks).where(tables.tasks.c.task_id == "a").values(state="running"))
    reply = desk.ask("read")
    assert ([task.task_id for task in reply.tasks], reply.damaged) == (["b"], 1)
    assert [each.thing for each in check(store.database)] == ["task 'a' of 'r1'"]
    assert store.repair("flat").done == ("1 tasks and schedules removed, their records are lost",)
    assert check(store.database) == []
    assert desk.states() == {"b": "queued"}
