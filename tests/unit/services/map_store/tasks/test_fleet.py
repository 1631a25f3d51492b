"""The queue of the fleet: tasks move while they wait, one at a time, and only who has one begins it."""

from concurrent.futures import ThreadPoolExecutor
from itertools import count

import pytest

from services.map_store.errors import ConflictError, InvalidError, MapError, MissingError
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.tasks.queue import TaskStore
from shared.messages.maps import MissionRecord
from shared.messages.tasks import Schedule, Task, TaskReply, TaskRequest
from shared.transport.keys import ANY

ROBOTS = ("r1", "r2", "r3")


class Office:
    """A store of tasks, and the records of three robots' missions."""

    def __init__(self, database: Database) -> None:
        ticks = count(10**9, 10**9)
        self.tasks = TaskStore(database, lambda: next(ticks))
        self.missions = MissionStore(database, lambda: next(ticks))
        for robot in ROBOTS:
            self.missions.claim(robot)

    def ask(self, queue: str, action: str, **fields: object) -> TaskReply:
        return self.tasks.answer(queue, TaskRequest.model_validate({"action": action, **fields}))

    def add(self, task_id: str, queue: str = ANY, **fields: object) -> Task:
        task = Task(task_id=task_id, robot=queue, kind="wave", map="flat", **fields)
        return self.about(self.ask(queue, "add", task=task))

    def move(self, task_id: str, source: str, target: str) -> Task:
        return self.about(self.ask(source, "move", task_id=task_id, to=target))

    def begin(self, robot: str, mission_id: str, **fields: object) -> None:
        record = {"robot": robot, "epoch": 1, "mission_id": mission_id, "action": "wave", "map": "flat"}
        self.missions.save(MissionRecord(**record, **fields))

    def end(self, robot: str, mission_id: str, outcome: str = "succeeded") -> None:
        record = {"robot": robot, "epoch": 1, "mission_id": mission_id, "ended_action": "wave"}
        self.missions.save(MissionRecord(**record, outcome=outcome))

    def waiting(self, queue: str) -> list[tuple[str, str]]:
        return [(task.task_id, task.robot) for task in self.ask(queue, "read").tasks]

    @staticmethod
    def about(reply: TaskReply) -> Task:
        assert reply.task is not None
        return reply.task


@pytest.fixture
def office(database: Database) -> Office:
    return Office(database)


def test_a_task_is_handed_over_taken_back_and_keeps_what_it_is(office: Office):
    added = office.add("a", priority=7, by="anna", parameters={"place": "kitchen"}, seed=3)
    assert (added.robot, added.fleet) == (ANY, True)
    handed = office.move("a", ANY, "r1")
    assert handed == added.model_copy(update={"robot": "r1"})
    assert office.waiting("r1") == office.waiting(ANY) == [("a", "r1")]
    assert office.move("a", "r1", ANY) == added
    assert (office.waiting("r1"), office.waiting(ANY)) == ([], [("a", ANY)])


def test_a_move_that_is_asked_again_is_done_once_even_when_the_task_runs_by_then(office: Office):
    office.add("a")
    for _ in range(2):
        assert office.move("a", ANY, "r1").robot == "r1"
    office.begin("r1", "a")
    assert office.move("a", ANY, "r1").state == "running"
    assert office.waiting(ANY) == [("a", "r1")]


def test_what_runs_or_is_over_stays_where_it_is(office: Office):
    office.add("a")
    office.move("a", ANY, "r1")
    office.begin("r1", "a")
    for target in (ANY, "r2"):
        with pytest.raises(ConflictError, match="task 'a' runs already: r1 has begun it"):
            office.move("a", "r1", target)
    office.end("r1", "a")
    with pytest.raises(ConflictError, match="task 'a' is over \\(succeeded\\)"):
        office.move("a", "r1", ANY)
    assert [(t.task_id, t.robot) for t in office.ask(ANY, "read", ended=5).ended] == [("a", "r1")]


def test_a_task_is_taken_only_from_who_has_it(office: Office):
    office.add("a")
    office.move("a", ANY, "r1")
    with pytest.raises(ConflictError, match="not with any: r1 has it"):
        office.move("a", ANY, "r2")
    with pytest.raises(ConflictError, match="not with r3: r1 has it"):
        office.move("a", "r3", ANY)
    assert office.waiting(ANY) == [("a", "r1")]


def test_a_robot_has_one_task_that_it_has_not_begun(office: Office):
    for task_id in ("a", "b"):
        office.add(task_id)
    office.add("own", "r1")
    office.move("a", ANY, "r1")
    with pytest.raises(ConflictError, match="task 'a' was handed to r1 and waits: one at a time"):
        office.move("b", ANY, "r1")
    office.begin("r1", "a")
    assert office.move("b", ANY, "r1").robot == "r1"


def test_what_cannot_be_moved_is_said(office: Office):
    office.add("a")
    office.add("own", "r1")
    with pytest.raises(InvalidError, match="task 'own' belongs to r1"):
        office.move("own", "r1", "r2")
    with pytest.raises(MissingError, match="the fleet has no task 'x'"):
        office.move("x", ANY, "r1")
    for nobody in ("", "maps"):
        with pytest.raises(InvalidError, match="a robot's name"):
            office.move("a", ANY, nobody)
    assert office.waiting(ANY) == [("a", ANY)]


def test_a_robot_that_lost_a_task_cannot_begin_it(office: Office):
    office.add("a")
    office.move("a", ANY, "r1")
    office.move("a", "r1", ANY)
    with pytest.raises(ConflictError, match="task 'a' is not with r1 any more: any has it"):
        office.begin("r1", "a")
    office.move("a", ANY, "r2")
    with pytest.raises(ConflictError, match="r2 has it"):
        office.begin("r1", "a")
    office.begin("r2", "a")
    office.end("r2", "a")
    with pytest.raises(ConflictError, match="r2 has it"):
        office.begin("r1", "a")


def test_what_a_low_battery_put_back_goes_on_with_another_robot_from_where_it_was(office: Office):
    office.add("a")
    office.move("a", ANY, "r1")
    office.begin("r1", "a", checkpoint={"visit": 3})
    office.ask("r1", "go_home", task=Task(task_id="home", robot="r1", kind="home", map="flat"))
    office.end("r1", "a", "cancelled")
    office.move("a", "r1", ANY)
    task = office.move("a", ANY, "r2")
    assert (task.mission_id, task.checkpoint) == ("a~1", {"visit": 3})
    with pytest.raises(ConflictError):
        office.begin("r1", "a")
    office.begin("r2", "a~1")
    office.end("r2", "a~1")
    assert office.about(office.ask(ANY, "read", task_id="a")).state == "succeeded"


def test_the_fleet_finds_its_tasks_wherever_they_are(office: Office):
    office.add("a")
    office.move("a", ANY, "r1")
    assert office.add("a").robot == "r1", "sent again, it is not added twice"
    assert office.about(office.ask(ANY, "prioritize", task_id="a", priority=9)).priority == 9
    assert office.about(office.ask(ANY, "cancel", task_id="a")).state == "cancelled"
    assert office.waiting("r1") == []
    with pytest.raises(MissingError, match="r2 has no task 'a'"):
        office.ask("r2", "cancel", task_id="a")


def test_an_id_of_the_fleet_is_nobody_elses(office: Office):
    office.add("a")
    office.add("own", "r1")
    with pytest.raises(ConflictError, match="another task 'a' already, of any"):
        office.add("a", "r2")
    with pytest.raises(ConflictError, match="another task 'own' already, of r1"):
        office.add("own")
    office.add("own", "r2")
    assert office.waiting("r2") == [("own", "r2")]


def test_tasks_of_robots_are_not_the_fleets(office: Office):
    office.add("own", "r1")
    assert office.waiting(ANY) == []
    assert office.ask(ANY, "read", task_id="own").task is None


@pytest.mark.parametrize("action", ["refuse", "go_home", "put_schedule", "make_due"])
def test_the_fleet_has_no_schedules_and_goes_nowhere(office: Office, action: str):
    schedule = Schedule(name="night", robot="r1", cron="0 22 * * *", task={"kind": "wave"})
    with pytest.raises(InvalidError, match=f"got {action}"):
        office.ask(ANY, action, schedule=schedule)


def test_a_task_of_the_same_id_that_a_schedule_made_stays_where_it_is(office: Office):
    office.add(f"night-{10**9}")
    schedule = Schedule(name="night", robot="r1", cron="0 22 * * *", task={"kind": "sing"})
    office.ask("r1", "put_schedule", schedule=schedule)
    made = office.about(office.ask("r1", "make_due", name="night", due_ns=10**18))
    with pytest.raises(ConflictError, match=f"there is another task '{made.task_id}' of r1 already"):
        office.move(made.task_id, ANY, "r1")
    assert office.about(office.ask("r1", "read", task_id=made.task_id)).kind == "sing"


def test_of_many_who_move_a_task_at_once_one_does(office: Office, database: Database):
    for number in range(6):
        office.add(f"t{number}")
    desks = [TaskStore(database, lambda: 1) for _ in ROBOTS]

    def hand_over(number: int, desk: TaskStore, robot: str) -> str:
        try:
            desk.answer(ANY, TaskRequest(action="move", task_id=f"t{number}", to=robot))
        except MapError as error:
            return error.code
        return robot

    with ThreadPoolExecutor(len(ROBOTS)) as pool:
        for number in range(3):
            asked = [pool.submit(hand_over, number, *one) for one in zip(desks, ROBOTS, strict=True)]
            answers = sorted(one.result() for one in asked)
            moved = [answer for answer in answers if answer in ROBOTS]
            assert (len(moved), answers.count("conflict")) == (1, 2)
            assert dict(office.waiting(ANY))[f"t{number}"] == moved[0]
    assert sorted(robot for _, robot in office.waiting(ANY)) == [ANY, ANY, ANY, *ROBOTS]
