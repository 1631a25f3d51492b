"""Tasks and schedules over HTTP: what reaches the queue, what is refused and how it is told, who may."""

from collections.abc import Callable, Iterator
from pathlib import Path

import httpx
import pytest

from services.map_store.errors import MapError
from services.map_store.storage.database import Database
from services.map_store.storage.missions import MissionStore
from services.map_store.tasks.queue import TaskStore
from shared.bus import Bus, wait_until
from shared.messages.maps import MissionRecord
from shared.messages.missions import MissionStatus
from shared.messages.tasks import QueueStatus, TaskRequest
from shared.topics import FLEET_QUEUE, QUEUE, TASKS
from shared.transport.keys import ANY
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S, sees
from tests.integration.gateway.keys import bearer, write_file
from tests.integration.gateway.standins import Peer, Planner

TASKS_URL, SCHEDULES_URL = "/api/robots/r1/tasks", "/api/robots/r1/schedules"
FLEET_URL = "/api/robots/any/tasks"
ERRAND = {"kind": "goto", "map": "flat", "parameters": {"place": "kitchen"}}
NIGHT = {"cron": "30 22 * * MON-FRI", "time_zone": "Europe/Zurich", "task": ERRAND}


class Store:
    """The map store's tasks and records of missions, on the bus."""

    def __init__(self, folder: Path) -> None:
        self.database = Database(f"sqlite:///{folder}/maps.sqlite3")
        ticks = iter(range(10**9, 10**15, 10**9))
        self._tasks = TaskStore(self.database, lambda: next(ticks))
        self.missions = MissionStore(self.database)

    def setup(self, bus: Bus) -> Callable[[], None]:
        requests = bus.requests(TASKS, queue="*")

        def turn() -> None:
            while (asked := requests.take()) is not None:
                try:
                    asked.reply(self._tasks.answer(asked.name, asked.message))
                except MapError as error:
                    asked.refuse(str(error), error.code)

        return turn

    def hand_over(self, task_id: str) -> None:
        """What the fleet service does with a task for whichever robot."""
        self._tasks.answer(ANY, TaskRequest(action="move", task_id=task_id, to="r1"))

    def begin(self, task_id: str) -> None:
        """What the planner saves when the mission of a task begins."""
        self.missions.save(MissionRecord(robot="r1", epoch=1, mission_id=task_id, action="goto"))


@pytest.fixture
def store(endpoint: str, gateway: str, planner: Planner, tmp_path: Path) -> Iterator[Store]:
    """An empty one that the gateway has met."""
    planner.status = MissionStatus(robot="r1")
    kept = Store(tmp_path)
    with Peer(endpoint, "map_store", kept.setup):
        assert wait_until(lambda: sees(gateway, ["map_store"]), WAIT_S)
        yield kept
    kept.database.close()


@pytest.mark.usefixtures("store")
def test_a_task_is_added_shown_moved_and_cancelled(http: httpx.Client):
    added = http.post(TASKS_URL, json=ERRAND)
    assert added.status_code == 201, added.text
    task = added.json()
    assert added.headers["location"] == f"{TASKS_URL}/{task['task_id']}"
    assert (task["state"], task["priority"], task["started"], task["due"]) == ("queued", 4, None, None)
    urgent = http.post(TASKS_URL, json={**ERRAND, "priority": 9, "task_id": "urgent"}).json()
    listed = http.get(TASKS_URL).json()
    assert [one["task_id"] for one in listed["tasks"]] == ["urgent", task["task_id"]]
    assert (listed["why"], listed["on_hold"], listed["damaged"]) == (None, False, 0)
    moved = http.patch(f"{TASKS_URL}/urgent", json={"priority": 0})
    assert (moved.status_code, moved.json()["priority"]) == (200, 0)
    assert http.delete(f"{TASKS_URL}/urgent").json()["state"] == "cancelled"
    assert http.get(f"{TASKS_URL}/urgent").json()["state"] == "cancelled"
    assert [one["task_id"] for one in http.get(TASKS_URL).json()["ended"]] == [urgent["task_id"]]


@pytest.mark.usefixtures("store")
def test_the_same_request_sent_again_adds_no_second_task(http: httpx.Client):
    for _ in range(2):
        assert http.post(TASKS_URL, json={**ERRAND, "task_id": "mine"}).status_code == 201
    assert len(http.get(TASKS_URL).json()["tasks"]) == 1


def test_a_task_that_runs_is_cancelled_with_its_mission(http: httpx.Client, store: Store, planner: Planner):
    http.post(TASKS_URL, json={**ERRAND, "task_id": "mine"})
    store.begin("mine")
    assert http.delete(f"{TASKS_URL}/mine").status_code == 200
    assert (planner.asked[-1].action, planner.asked[-1].mission_id) == ("cancel", "mine")


@pytest.mark.usefixtures("store")
@pytest.mark.parametrize(
    ("body", "code", "words"),
    [
        ({**ERRAND, "kind": "fly"}, "unknown_kind", "one of explore, goto"),
        ({**ERRAND, "kind": "cancel"}, "unknown_kind", "a kind of mission"),
        ({**ERRAND, "parameters": {"speed": 3}}, "unknown_parameter", "parameters of goto: "),
        ({"kind": "patrol", "map": "flat"}, "missing_parameter", "patrol needs: places"),
        ({**ERRAND, "priority": 10}, "invalid_request", "priority"),
    ],
)
def test_what_the_planner_does_not_know_is_refused_before_it_waits(http: httpx.Client, body, code, words):
    answer = http.post(TASKS_URL, json=body)
    assert (answer.status_code, answer.json()["type"]) == (422, f"urn:topnav:problem:{code}")
    assert words in answer.json()["detail"]


@pytest.mark.usefixtures("store")
def test_what_is_not_there_is_told(http: httpx.Client):
    for method, path in (
        ("GET", f"{TASKS_URL}/none"),
        ("DELETE", f"{TASKS_URL}/none"),
        ("GET", f"{SCHEDULES_URL}/none"),
        ("DELETE", f"{SCHEDULES_URL}/none"),
        ("GET", "/api/robots/nobody/tasks"),
    ):
        answer = http.request(method, path)
        assert answer.status_code == 404, path
    assert http.patch(f"{TASKS_URL}/none", json={"priority": 3}).status_code == 404


def test_a_task_that_runs_cannot_be_moved(http: httpx.Client, store: Store):
    http.post(TASKS_URL, json={**ERRAND, "task_id": "mine"})
    store.begin("mine")
    answer = http.patch(f"{TASKS_URL}/mine", json={"priority": 3})
    assert answer.status_code == 409
    assert "runs already" in answer.json()["got"]


@pytest.mark.usefixtures("store")
def test_a_schedule_is_set_shown_with_its_next_time_and_removed(http: httpx.Client):
    answer = http.put(f"{SCHEDULES_URL}/night", json=NIGHT)
    assert answer.status_code == 200, answer.text
    shown = answer.json()
    assert (shown["cron"], shown["task"]["kind"], shown["skipped"]) == ("30 22 * * MON-FRI", "goto", 0)
    assert shown["next"][11:16] in ("20:30", "21:30"), "22:30 in Zurich"
    assert http.get(f"{SCHEDULES_URL}/night").json() == shown
    assert http.get(SCHEDULES_URL).json() == [shown]
    off = http.put(f"{SCHEDULES_URL}/night", json={**NIGHT, "enabled": False}).json()
    assert (off["enabled"], off["next"]) == (False, None)
    assert http.delete(f"{SCHEDULES_URL}/night").status_code == 204
    assert http.get(SCHEDULES_URL).json() == []


@pytest.mark.usefixtures("store")
@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"cron": "0 25 * * *"}, "field hour cannot be '25': '30 7 * * MON-FRI' is 7:30 on workdays"),
        ({"cron": "every day"}, "5 fields expected"),
        ({"time_zone": "Mars/Base"}, "unknown time zone 'Mars/Base'"),
        ({"task": {**ERRAND, "kind": "fly"}}, "one of explore, goto"),
    ],
)
def test_a_schedule_that_is_none_says_what_is_wrong(http: httpx.Client, changes, words):
    answer = http.put(f"{SCHEDULES_URL}/night", json={**NIGHT, **changes})
    assert answer.status_code == 422
    assert words in answer.json()["detail"]


@pytest.mark.usefixtures("store")
def test_what_keeps_the_queue_is_told_as_the_dispatch_service_says_it(
    http: httpx.Client, endpoint: str, gateway: str
):
    def setup(bus: Bus) -> Callable[[], None]:
        said = bus.publisher(QUEUE, robot="r1")
        status = QueueStatus(robot="r1", why="anna drives by hand", on_hold=True, alarm="not at home")
        return lambda: said.put(status)

    def heard() -> bool:
        listed = http.get(TASKS_URL).json()
        told = listed["why"], listed["on_hold"], listed["alarm"]
        return bool(told == ("anna drives by hand", True, "not at home"))

    with Peer(endpoint, "dispatch", setup):
        assert wait_until(lambda: sees(gateway, ["dispatch"]), WAIT_S)
        assert wait_until(heard, WAIT_S)


def test_a_task_of_the_fleet_is_found_moved_and_cancelled_whoever_has_it(
    http: httpx.Client, store: Store, planner: Planner
):
    added = http.post(FLEET_URL, json={**ERRAND, "task_id": "ours"})
    assert (added.status_code, added.headers["location"]) == (201, f"{FLEET_URL}/ours")
    assert (added.json()["robot"], added.json()["fleet"]) == ("any", True)
    assert http.get(TASKS_URL).json()["tasks"] == []
    store.hand_over("ours")
    (listed,) = http.get(FLEET_URL).json()["tasks"]
    assert [listed] == http.get(TASKS_URL).json()["tasks"]
    assert listed["robot"] == "r1"
    assert http.patch(f"{FLEET_URL}/ours", json={"priority": 9}).json()["priority"] == 9
    store.begin("ours")
    asked = len(planner.asked)
    assert http.delete(f"{FLEET_URL}/ours").status_code == 200
    assert [(wish.action, wish.mission_id) for wish in planner.asked[asked:]] == [("cancel", "ours")]


@pytest.mark.usefixtures("store")
def test_the_fleet_is_no_robot(http: httpx.Client):
    assert http.post(FLEET_URL, json={**ERRAND, "kind": "fly"}).status_code == 422
    assert http.post("/api/robots/any/missions", json={"action": "explore", "map": "flat"}).status_code == 422
    assert http.put("/api/robots/any/schedules/night", json=NIGHT).status_code == 422
    assert http.get("/api/robots/maps/tasks").status_code == 422


@pytest.mark.usefixtures("store")
def test_what_the_fleets_tasks_wait_for_is_told_as_the_fleet_service_says_it(
    http: httpx.Client, endpoint: str, gateway: str
):
    def setup(bus: Bus) -> Callable[[], None]:
        said = bus.publisher(FLEET_QUEUE)
        return lambda: said.put(QueueStatus(robot=ANY, why="r1: anna drives by hand"))

    assert http.get(FLEET_URL).json()["why"] is None
    with Peer(endpoint, "fleet", setup):
        assert wait_until(lambda: sees(gateway, ["fleet"]), WAIT_S)
        assert wait_until(
            lambda: bool(http.get(FLEET_URL).json()["why"] == "r1: anna drives by hand"), WAIT_S
        )
    assert "any" not in [robot["robot"] for robot in http.get("/api/robots").json()]


def test_an_agent_cancels_what_waits_and_not_what_runs(
    endpoint: str, planner: Planner, store: Store, tmp_path: Path
):
    file = write_file(tmp_path / "tokens.json")
    for address in serve_gateway(endpoint, ["planner", "map_store"], tokens_file=file):
        with httpx.Client(
            base_url=address, headers=bearer("agent"), trust_env=False, timeout=WAIT_S
        ) as agent:
            for task_id in ("one", "two"):
                assert agent.post(TASKS_URL, json={**ERRAND, "task_id": task_id}).json()["by"]
            assert agent.delete(f"{TASKS_URL}/one").json()["state"] == "cancelled"
            store.begin("two")
            asked = len(planner.asked)
            answer = agent.delete(f"{TASKS_URL}/two")
            assert (answer.status_code, answer.json()["needed"]) == (403, "operator")
            assert len(planner.asked) == asked
