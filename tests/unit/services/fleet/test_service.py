"""The fleet loop against a bus that is none: when it hands out, what a refusal means, which maps it reads."""

import threading
from typing import Any

import pytest

from services.fleet.maps import Maps
from services.fleet.service import LISTENS_S, Fleet, run
from services.fleet.settings import FleetSettings
from services.fleet.traffic.rights import Claim
from shared.messages.estop import EStopState
from shared.messages.maps import Edge, MapDelta, MapReply, Node
from shared.messages.missions import MissionStatus
from shared.messages.places import OneWay
from shared.messages.tasks import QueueStatus, Task, TaskReply, TaskRequest
from shared.queries import RefusedError
from shared.topics import ESTOP_STATE, MAP_DELTA, MAP_READ, QUEUE, STATUS
from shared.transport.keys import ANY

LINE = MapReply(
    map="flat",
    revision=1,
    nodes=tuple(Node(node_id=n) for n in range(4)),
    edges=tuple(Edge(a=n, b=n + 1, length_m=1.0) for n in range(3)),
)
"""Four nodes, a metre apart."""


class Inbox:
    """What waits on one topic."""

    def __init__(self) -> None:
        self.waiting: list[Any] = []

    def take_all(self) -> list[Any]:
        taken, self.waiting = self.waiting, []
        return taken


class Bus:
    """Answers for the map store, and keeps what it was asked and told."""

    def __init__(self) -> None:
        self.inboxes: dict[Any, Inbox] = {}
        self.tasks: tuple[Task, ...] = ()
        self.moved: list[tuple[str, str, str]] = []
        self.refuses: set[str] = set()
        self.maps_read: list[str] = []
        self.map = MapReply(map="flat", revision=1)
        self.said: list[QueueStatus] = []
        self.counters, self.counted = self, []

    def count(self, _kind, reason):
        self.counted.append(reason)

    def subscribe(self, topic, **names):
        return self.inboxes.setdefault((topic, *names.values()), Inbox())

    def publisher(self, _topic):
        return self

    def put(self, status):
        self.said.append(status)

    def ask(self, query, request, _timeout_s, queue="", **names):
        if query is MAP_READ:
            self.maps_read.append(names["map"])
            if names["map"] == "none":
                raise RefusedError("no such map", "missing")
            return self.map
        if isinstance(request, TaskRequest) and request.action == "move":
            if request.task_id in self.refuses:
                raise RefusedError("it runs already", "conflict")
            self.moved.append((request.task_id, queue, request.to))
        return TaskReply(robot=ANY, tasks=self.tasks)


class Stage:
    """A fleet service and what robots say."""

    def __init__(self, **settings: object) -> None:
        self.bus = Bus()
        self.in_the_way: list[Claim] = []
        self.fleet = Fleet(FleetSettings(**settings), self.bus, lambda _now_s: self.in_the_way)

    def free(self, *names: str, node: int | None = 0, at: str = "flat") -> None:
        """They have nothing to do; said to everybody, as robots do."""
        for name in names:
            status = MissionStatus(robot=name, mission_id="m", map=at, nearest_node=node)
            for topic, message in (
                (STATUS, status),
                (ESTOP_STATE, EStopState(robot=name, engaged=False)),
                (QUEUE, QueueStatus(robot=name)),
            ):
                self.bus.subscribe(topic, robot=name).waiting.append(message)
            self.bus.subscribe(STATUS, robot="*").waiting.append(status)

    def works(self, name: str) -> None:
        """It drives, for a task."""
        self.free(name)
        status = MissionStatus(robot=name, mission_id="z", map="flat", state="running")
        self.bus.subscribe(STATUS, robot=name).waiting.append(status)

    def step(self, now_s: float) -> QueueStatus:
        self.fleet.step(now_s)
        return self.bus.said[-1]


def task(task_id: str, robot: str = ANY, **fields: object) -> Task:
    about = {"task_id": task_id, "robot": robot, "kind": "goto", "map": "flat", "fleet": True, **fields}
    return Task.model_validate(about)


def test_it_listens_before_it_hands_out_anything():
    stage = Stage()
    stage.bus.tasks = (task("a"),)
    stage.free("r1")
    assert stage.step(100.0).waiting == 1
    stage.step(100.0 + LISTENS_S - 0.1)
    assert stage.bus.moved == []
    stage.step(100.0 + LISTENS_S)
    assert stage.bus.moved == [("a", ANY, "r1")]


def test_a_move_that_is_refused_keeps_no_other():
    stage = Stage()
    stage.bus.tasks, stage.bus.refuses = (task("a"), task("b")), {"a"}
    stage.step(0.0)
    stage.free("r1", "r2")
    stage.step(LISTENS_S)
    assert stage.bus.moved == [("b", ANY, "r2")]
    assert stage.bus.counted == ["it runs already"]


def test_a_robot_that_has_a_task_and_says_nothing_is_known_and_gives_it_back():
    stage = Stage(silent_s=3.0)
    stage.bus.tasks = (task("a", "r9"),)
    stage.step(50.0)
    stage.step(52.9)
    assert stage.bus.moved == []
    stage.step(53.0)
    assert stage.bus.moved == [("a", "r9", ANY)]


def test_a_robot_that_was_heard_falls_silent_after_a_while():
    stage = Stage(silent_s=3.0)
    stage.bus.tasks = (task("a", "r1"),)
    stage.free("r1")
    stage.step(0.0)
    for now_s in (5.0, 5.5, 8.4):
        stage.step(now_s)
    assert stage.bus.moved == []
    stage.step(8.5)
    assert stage.bus.moved == [("a", "r1", ANY)]


def test_one_whose_dispatch_alone_is_silent_gives_back_what_it_would_never_begin():
    stage = Stage(silent_s=0.0)
    stage.bus.tasks = (task("a", "r1"),)
    for now_s in (0.0, 3.0, 5.1):
        stage.free("r1")
        if now_s:
            stage.bus.subscribe(QUEUE, robot="r1").take_all()
        stage.step(now_s)
    assert stage.bus.moved == [("a", "r1", ANY)]


def test_the_nearest_is_found_along_the_edges_as_the_rules_allow():
    stage = Stage()
    stage.bus.tasks = (task("a", parameters={"goal_node": 2}),)
    stage.bus.map = LINE
    stage.step(0.0)
    stage.free("r1", node=0)
    stage.free("r2", node=3)
    stage.step(LISTENS_S)
    assert stage.bus.moved.pop() == ("a", ANY, "r2")
    away = OneWay(name="away", edges=((2, 3),))
    stage.bus.map = LINE.model_copy(update={"rules": (away,)})
    stage.bus.subscribe(MAP_DELTA, map="*").waiting.append(MapDelta(map="flat", revision=2))
    stage.free("r1", node=0)
    stage.free("r2", node=3)
    stage.step(20.0)
    assert stage.bus.moved.pop() == ("a", ANY, "r1")


@pytest.mark.parametrize(("at", "nearest"), [("flat", "r2"), ("yard", "r1")])
def test_who_names_no_node_at_its_goal_is_near_the_last_one_of_that_map(at, nearest):
    stage = Stage()
    stage.bus.map = LINE
    stage.step(0.0)
    stage.free("r2", node=3)
    stage.step(1.0)
    stage.free("r2", node=None, at=at)
    stage.step(2.0)
    stage.bus.tasks = (task("a", parameters={"goal_node": 2}),)
    stage.free("r1", node=0)
    stage.free("r2", node=None)
    stage.step(LISTENS_S)
    assert stage.bus.moved == [("a", ANY, nearest)]


def test_what_was_overtaken_once_by_each_other_robot_comes_next():
    stage = Stage()
    stage.bus.map = LINE
    far, *near = (task(name, parameters={"goal_node": node}) for name, node in (("a", 3), ("b", 1), ("c", 0)))
    stage.step(0.0)
    for now_s, waiting, given in ((LISTENS_S, (far, *near), "b"), (LISTENS_S + 1.0, (far, near[1]), "a")):
        stage.free("r1", node=0)
        stage.works("r2")
        stage.bus.tasks = (*waiting, task("z", "r2", state="running"))
        stage.step(now_s)
        assert stage.bus.moved.pop() == (given, ANY, "r1")


def test_no_more_robots_are_followed_than_it_may():
    stage = Stage(max_robots=1)
    stage.bus.tasks = (task("a"), task("b"))
    stage.step(0.0)
    stage.free("r1", "r2")
    stage.step(LISTENS_S)
    assert stage.bus.moved == [("a", ANY, "r1")]


def test_a_map_is_read_again_when_it_changed_and_not_too_often():
    bus = Bus()
    maps = Maps(bus, period_s=10.0, timeout_s=1.0)
    for now_s, changes, reads in [
        (0.0, False, 1),
        (1.0, True, 1),
        (9.9, False, 1),
        (10.0, False, 2),
        (30.0, False, 2),
    ]:
        if changes:
            bus.subscribe(MAP_DELTA, map="*").waiting.append(MapDelta(map="flat", revision=2))
        maps.follow()
        maps.graph("flat", now_s)
        assert len(bus.maps_read) == reads, now_s


def test_a_map_that_is_missing_has_no_ways():
    assert Maps(Bus(), 10.0, 1.0).graph("none", 0.0).nodes == {}


@pytest.mark.parametrize(("damaged", "alarm"), [(0, ""), (2, "2 records of tasks are damaged")])
def test_damaged_records_are_an_alarm(damaged: int, alarm: str, monkeypatch: pytest.MonkeyPatch):
    stage = Stage()
    answer = TaskReply(robot=ANY, damaged=damaged)
    monkeypatch.setattr(stage.bus, "ask", lambda *_, **__: answer)
    assert stage.step(0.0).alarm.startswith(alarm)
    assert bool(stage.bus.said[-1].alarm) == bool(alarm)


def test_the_process_ends_where_its_desk_for_rights_of_way_failed(monkeypatch):
    """Another one is started then; robots wait for one that is there and says nothing."""

    class Failing:
        def __init__(self, *_: object) -> None:
            self.to_send = lambda _now_s: []

        def announce(self) -> None:
            pass

        def serve(self, _stop: threading.Event) -> None:
            raise LookupError("a bug")

    monkeypatch.setattr("services.fleet.service.Desk", Failing)
    with pytest.raises(LookupError, match="a bug"):
        run(FleetSettings(period_s=0.01), Bus(), threading.Event())
