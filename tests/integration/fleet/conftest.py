"""Three robots in one map, the map store, and the process that hands out the fleet's tasks."""

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
import zenoh

from services.launcher.processes.free_ports import free_ports
from shared.bus import Bus, open_bus, wait_until
from shared.messages.maps import AddNode, Edge, MapRequest, Node, PutEdge
from shared.messages.tasks import Task, TaskReply, TaskRequest
from shared.topics import MAP, TASKS
from shared.transport.keys import ANY
from shared.transport.router_config import router_config
from tests.bare_places import FEATURES
from tests.integration.fleet.robots import Child, FleetRobot
from tests.integration.map_store.conftest import START_S

ANSWER_S = 60.0
NODES = 21
"""Along a corridor, a metre apart."""
ROOM = (10, 21, 22, 23)
"""Nodes from one of the corridor into a room."""
PLACES = {"r1": 0, "r2": 10, "r3": 20}
"""Where the robots stand at first."""


class FleetQueue:
    """The queue of the fleet, or of one robot, asked over the bus."""

    def __init__(self, bus: Bus) -> None:
        self._bus = bus

    def ask(self, action: str, queue: str = ANY, **fields: object) -> TaskReply:
        request = TaskRequest.model_validate({"action": action, **fields})
        return self._bus.ask(TASKS, request, ANSWER_S, queue=queue)

    def add(self, task_id: str, node: int, queue: str = ANY, **fields: object) -> None:
        parameters = {"goal_node": node, "name": task_id, **fields}
        self.ask(
            "add",
            queue,
            task=Task(task_id=task_id, robot=queue, kind="stand", map="flat", parameters=parameters),
        )

    def task(self, task_id: str, queue: str = ANY) -> Task:
        found = self.ask("read", queue, task_id=task_id).task
        assert found is not None
        return found


@pytest.fixture(scope="module")
def endpoint(patient_sessions: None) -> Iterator[str]:  # noqa: ARG001
    """A router."""
    address = f"tcp/127.0.0.1:{free_ports(1)[0]}"
    with zenoh.open(router_config(address)):
        yield address


@pytest.fixture(scope="module")
def bus(endpoint: str) -> Iterator[Bus]:
    """A session of whoever asks."""
    with open_bus(endpoint) as opened:
        yield opened


@pytest.fixture(scope="module")
def corridor(bus: Bus, endpoint: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """A map store with a corridor of nodes, and the fleet service."""
    store = Child(
        "map_store",
        {
            "TOPNAV_ENDPOINT": endpoint,
            "MAP_STORE_PORT": str(free_ports(1)[0]),
            "MAP_STORE_DATABASE_URL": f"sqlite:///{tmp_path_factory.mktemp('maps')}/maps.sqlite3",
        },
    )
    fleet = Child("fleet", {"TOPNAV_ENDPOINT": endpoint, "FLEET_PERIOD_S": "0.2", "FLEET_SILENT_S": "0.5"})
    try:
        assert wait_until(lambda: {"map_store", "fleet"} <= set(bus.alive()), START_S)
        bus.ask(MAP, MapRequest(action="create"), ANSWER_S, map="flat")
        numbers = (*range(NODES), *ROOM[1:])
        nodes = [AddNode(node=Node(node_id=number), features=FEATURES) for number in numbers]
        legs = (*pairwise(range(NODES)), *pairwise(ROOM))
        edges = [PutEdge(edge=Edge(a=a, b=b, length_m=1.0, traversals=1)) for a, b in legs]
        wish = MapRequest(action="transact", operations=(*nodes, *edges))
        bus.ask(MAP, wish, ANSWER_S, map="flat")
        yield
    finally:
        fleet.kill()
        store.kill()


@pytest.fixture
def queue(bus: Bus, corridor: None) -> FleetQueue:  # noqa: ARG001
    """The fleet's queue."""
    return FleetQueue(bus)


@pytest.fixture
def robots(queue: FleetQueue, bus: Bus, endpoint: str) -> Iterator[dict[str, FleetRobot]]:
    """Three robots that stand where PLACES says and have nothing to do."""
    there: dict[str, FleetRobot] = {}
    try:
        for name in PLACES:
            there[name] = FleetRobot(name, endpoint)
        assert wait_until(lambda: bus.alive("dispatch") == ["dispatch"] * len(PLACES), START_S)
        for name, node in PLACES.items():
            queue.add(f"place-{name}", node, queue=name)
        standing = {f"place-{name}": name for name in PLACES}
        assert wait_until(
            lambda: all(queue.task(one, name).state == "succeeded" for one, name in standing.items()),
            ANSWER_S,
        )
        yield there
    finally:
        for robot in there.values():
            robot.kill()


@pytest.fixture
def begun(tmp_path: Path) -> Path:
    """The file in which tasks note that they begin."""
    return tmp_path / "begun"
