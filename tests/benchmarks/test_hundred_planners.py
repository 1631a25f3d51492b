"""Planners of many robots that write to one map store at once; gates nothing.

pytest -q -s tests/benchmarks/test_hundred_planners.py
PLANNERS=10,100 MAPS=own,one SECONDS=120 pytest -q -s tests/benchmarks/test_hundred_planners.py

What one planner wrote while it explored the plan of the apartment is written by each again, at the pace of
the robot and from a bus session of its own, which hears of its map as planners do. Sessions are clients of
the router, as on a secured bus: peers would each be linked to each other, 4,950 links for a hundred.
MAPS=own: each maps a place of its own. MAPS=one: all drive in one map, and note an edge as driven every three
seconds.
"""

import multiprocessing
import os
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from contextlib import contextmanager

import numpy as np
import pytest
import zenoh

from services.drive.limits import DriveLimits
from services.planner.missions.explore import FrontierExploration
from services.planner.profiles import DEFAULT
from services.planner.remote.map_changes import MapChanges
from services.planner.remote.remote_map import RemoteMap
from shared.bus import Bus, open_bus, wait_until
from shared.messages.maps import AddNode, Operation, PutEdge
from shared.queries import AbsentError, QueryError, TimedOutError
from shared.transport.session_config import looker_config
from tests.benchmarks.test_map_store_databases import features_of_a_place
from tests.integration.map_store.conftest import START_S, Process
from tests.plane_exploration import MOST_STEPS, START
from tests.plane_world import STEP_S, PlaneMap, PlaneMatcher, PlaneWorld, run

pytestmark = [pytest.mark.slow, pytest.mark.timeout(3600)]

PLANNERS = [int(count) for count in os.environ.get("PLANNERS", "10,100").split(",")]
MAPS = os.environ.get("MAPS", "own,one").split(",")
SECONDS = float(os.environ.get("SECONDS", "60"))
PROCESSES = 4
LEG_S, TIMEOUT_S = 3.0, 10.0
ONE = "building"

Writes = Sequence[tuple[float, Sequence[Operation]]]


class Recorded(PlaneMap):
    """A map that keeps what is written to it, and in which frame."""

    def commit(self, operations):
        super().commit(operations)
        self.writes.append((self.world.seq * STEP_S, tuple(operations)))


@pytest.fixture(scope="module")
def writes():
    """What a planner writes, by the seconds since its robot set out."""
    world, maps = PlaneWorld(START, np.random.default_rng(1)), Recorded()
    maps.world, maps.writes = world, []
    mission = FrontierExploration(DEFAULT, maps, PlaneMatcher(world, maps), np.random.default_rng(1))
    run(world, mission, DriveLimits(), MOST_STEPS)
    return maps.writes


def as_seen(operations: Sequence[Operation], rng: np.random.Generator) -> list[Operation]:
    """The same with features of the size of the default pipeline's."""
    features = features_of_a_place(rng)
    return [
        operation.model_copy(update={"features": features}) if isinstance(operation, AddNode) else operation
        for operation in operations
    ]


@contextmanager
def client_of(endpoint: str) -> Iterator[Bus]:
    """A session that knows the router only."""
    bus = Bus(zenoh.open(looker_config(endpoint)))
    try:
        yield bus
    finally:
        bus.close()


def loaded(maps: RemoteMap) -> bool:
    """Whether the map store answered: a new session knows it only after a while."""
    try:
        maps.load(create=True)
    except (AbsentError, TimedOutError):
        return False
    return True


class Planner:
    """One of them, as far as the map store knows."""

    def __init__(self, endpoint: str, number: int, writes: Writes, one: bool) -> None:
        self._endpoint, self._number, self._writes, self._one = endpoint, number, writes, one
        self._rng = np.random.default_rng(number)

    def run(self, begin_s: float) -> tuple[list[float], list[str]]:
        """Seconds that each write took, and what went wrong."""
        took_s, wrong = [], []
        with client_of(self._endpoint) as bus:
            name, deltas = ONE if self._one else f"m{self._number}", MapChanges(bus)
            maps = RemoteMap(bus, name, TIMEOUT_S, changes=deltas)
            deltas.follow(name)
            assert wait_until(lambda: loaded(maps), START_S, 0.1)
            for at_s, operations in self._due():
                since_s = None
                try:
                    self._follow(maps, deltas, begin_s + at_s)
                    wanted = operations or self._driven(maps)
                    since_s = time.perf_counter()
                    maps.commit(wanted)
                except QueryError as error:
                    wrong.append(str(error))
                if since_s is not None:
                    took_s.append(time.perf_counter() - since_s)
        return took_s, wrong

    @staticmethod
    def _follow(maps: RemoteMap, deltas: MapChanges, until_s: float) -> None:
        """As a planner does between its writes."""
        while time.time() < until_s:
            for delta in deltas.take_all():
                maps.follow(delta)
            time.sleep(min(0.1, max(0.0, until_s - time.time())))

    def _due(self):
        """What to write and when, each planner from a moment of its own on."""
        phase_s = float(self._rng.uniform(0.0, LEG_S))
        if self._one:
            yield from ((phase_s + leg * LEG_S, ()) for leg in range(int((SECONDS - phase_s) / LEG_S)))
            return
        for at_s, operations in self._writes:
            if phase_s + at_s < SECONDS:
                yield phase_s + at_s, as_seen(operations, self._rng)

    def _driven(self, maps: RemoteMap) -> list[Operation]:
        edges = sorted(maps.graph.edges)
        edge = maps.graph.edges[edges[int(self._rng.integers(len(edges)))]]
        return [PutEdge(edge=edge.model_copy(update={"traversals": edge.traversals + 1}))]


def some(endpoint: str, numbers: Sequence[int], writes: Writes, one: bool, begin_s: float):
    """Planners of one process, a thread each."""
    with ThreadPoolExecutor(len(numbers)) as threads:
        return list(threads.map(lambda n: Planner(endpoint, n, writes, one).run(begin_s), numbers))


@pytest.fixture
def endpoint(repository, tmp_path, router_endpoint, free_port):
    """A map store process with a map that somebody made already."""
    store = Process(repository, tmp_path, router_endpoint, free_port())
    store.start()
    with open_bus(router_endpoint) as bus:
        assert wait_until(lambda: bool(bus.alive("map_store")), START_S, 0.1)
        yield router_endpoint
    store.kill()


@pytest.mark.parametrize("maps", MAPS)
@pytest.mark.parametrize("count", PLANNERS)
def test_writes_of_many_planners(count, maps, endpoint, writes, keep):
    with open_bus(endpoint) as bus:
        whole = RemoteMap(bus, ONE, TIMEOUT_S)
        whole.load(create=True)
        for _, operations in writes:
            whole.commit(as_seen(operations, np.random.default_rng(0)))
    begin_s = time.time() + 10.0 + count / 10.0
    groups = [list(range(count))[each::PROCESSES] for each in range(min(PROCESSES, count))]
    with ProcessPoolExecutor(len(groups), multiprocessing.get_context("spawn")) as processes:
        asked = [processes.submit(some, endpoint, group, writes, maps == "one", begin_s) for group in groups]
        played = [planner for each in asked for planner in each.result()]
    took_ms = 1e3 * np.concatenate([took_s for took_s, _ in played])
    keep(
        {
            "planners": count,
            "maps": maps,
            "writes": len(took_ms),
            "writes_per_s": len(took_ms) / SECONDS,
            "median_ms": np.median(took_ms),
            "p99_ms": np.percentile(took_ms, 99),
            "most_ms": took_ms.max(),
            "wrong": sum(len(wrong) for _, wrong in played),
        }
    )
