"""Two planners write to one map of a real map store at once: nothing is lost, each hears of the other."""

import threading
import time
from itertools import pairwise

import pytest

from services.planner.mapping.edges import NewEdges
from services.planner.mapping.nodes import add_node
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from services.planner.remote.map_changes import MapChanges
from services.planner.remote.remote_map import RemoteMap
from shared.bus import open_bus, wait_until
from shared.mapgraph.frontiers import sector_rad
from shared.messages.base import SECTORS
from shared.messages.maps import AddNode, Edge, Node, PutEdge, UpdateNode
from shared.messages.sensors import Ranges
from shared.queries import RefusedError
from shared.topics import MAP_DELTA
from tests.bare_places import FEATURES, sectors
from tests.integration.map_store.conftest import bus as bus
from tests.integration.map_store.conftest import process as process

TIMEOUT_S = 60.0
PLACES, BETWEEN_S = 40, 0.02
"""Much more often than a robot finds a place."""

pytestmark = pytest.mark.usefixtures("patient_sessions")


def add(maps, stamp_ns, to=None):
    """What a planner does for a new place, with an edge; the id that the place got."""
    node_id = maps.graph.next_id()
    operations = [AddNode(node=Node(node_id=node_id, stamp_ns=stamp_ns), features=FEATURES)]
    if to is not None:
        operations.append(PutEdge(edge=Edge(a=to, b=node_id, inliers=stamp_ns)))
    maps.commit(operations)
    return max(maps.graph.nodes)


@pytest.fixture
def two(bus):
    """The same map as two planners see it."""
    first, second = RemoteMap(bus, "flat", TIMEOUT_S), RemoteMap(bus, "flat", TIMEOUT_S)
    first.load(create=True)
    add(first, 1)
    second.load(create=True)
    return first, second


def stored(bus):
    """The map as the store has it."""
    found = RemoteMap(bus, "flat", TIMEOUT_S)
    found.load(create=False)
    return found.graph


def test_places_made_at_once_get_an_id_each(two, bus):
    first, second = two
    assert (add(first, 2, to=0), add(second, 3, to=0)) == (1, 2)
    assert {n.node_id: n.stamp_ns for n in stored(bus).nodes.values()} == {0: 1, 1: 2, 2: 3}
    assert {ends: e.inliers for ends, e in stored(bus).edges.items()} == {(0, 1): 2, (0, 2): 3}


def test_a_planner_knows_its_new_place_by_the_id_that_it_got(two):
    first, second = two
    add(first, 2)
    angles_rad = tuple(sector_rad(n) for n in range(SECTORS))
    ranges = Ranges(robot="r2", angles_rad=angles_rad, distances_m=(4.0,) * SECTORS, max_range_m=4.0)
    seen = Observation(FEATURES.model_copy(update={"stamp_ns": 3}), ranges)
    node_id, _ = add_node(second, seen, NewEdges(), DEFAULT, None)
    assert (node_id, second.graph.nodes[node_id].stamp_ns) == (2, 3)


def test_who_comes_second_hears_what_came_first_and_reads_no_whole_map(bus):
    changes = MapChanges(bus)
    first, second = RemoteMap(bus, "flat", TIMEOUT_S), RemoteMap(bus, "flat", TIMEOUT_S, changes=changes)
    changes.follow("flat")
    first.load(create=True)
    add(first, 1)
    second.load(create=True)
    assert wait_until(lambda: 1 in {delta.revision for delta in changes.take_all()}, TIMEOUT_S)
    before = second.graph
    assert (add(first, 2, to=0), add(second, 3, to=0)) == (1, 2)
    assert second.graph is before
    assert stored(bus).nodes.keys() == second.graph.nodes.keys() == {0, 1, 2}
    assert stored(bus).edges == second.graph.edges


def test_directions_explored_at_once_are_both_kept(two, bus):
    for maps, sector in zip(two, (3, 8), strict=True):
        maps.commit([UpdateNode(node=Node(node_id=0, stamp_ns=1, explored=sectors(sector)))])
    assert stored(bus).nodes[0].explored == sectors(3, 8)


@pytest.mark.usefixtures("two")
def test_dozens_of_writes_of_two_planners_are_all_there(bus, router_endpoint, monkeypatch):
    # Where each answer takes as long as the pause, the same one may come second ten times in a row.
    monkeypatch.setattr("services.planner.remote.remote_map.WRITE_TRIES", 10 * PLACES)
    made = {}

    def work(which):
        with open_bus(router_endpoint) as own:
            assert wait_until(lambda: own.alive("map_store") != [], TIMEOUT_S)
            maps = RemoteMap(own, "flat", TIMEOUT_S)
            maps.load(create=False)
            ids = [0]
            for number in range(PLACES):
                ids.append(add(maps, 1000 * which + number, to=ids[-1]))
                time.sleep(BETWEEN_S)
            made[which] = ids

    threads = [threading.Thread(target=work, args=(which,)) for which in (1, 2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert made.keys() == {1, 2}
    graph = stored(bus)
    assert len(graph.nodes) == 1 + 2 * PLACES
    for which, ids in made.items():
        assert [graph.nodes[n].stamp_ns for n in ids[1:]] == [1000 * which + k for k in range(PLACES)]
        assert all(graph.edge(a, b) is not None for a, b in pairwise(ids))


def test_a_follower_takes_over_what_the_other_wrote(two, bus):
    first, second = two
    deltas = bus.subscribe(MAP_DELTA, map="flat")

    def caught_up():
        for delta in deltas.take_all():
            if delta.revision > second.revision:
                second.follow(delta)
        return second.revision == first.revision

    before = second.graph
    add(first, 2, to=0)
    assert wait_until(caught_up, TIMEOUT_S)
    assert second.graph is before, "applied, not read again"
    for stamp_ns in (3, 4):
        add(first, stamp_ns, to=0)
    assert wait_until(caught_up, TIMEOUT_S)
    assert (second.graph.nodes, second.graph.edges) == (first.graph.nodes, first.graph.edges)


def test_both_may_make_the_map(bus):
    first, second = RemoteMap(bus, "hall", TIMEOUT_S), RemoteMap(bus, "hall", TIMEOUT_S)
    first.load(create=True)
    second._create()
    second.load(create=True)
    assert first.revision == second.revision == 0


def test_a_place_whose_answer_got_lost_is_not_written_twice(two, bus):
    first, _ = two
    behind, revision = first.graph, first.revision
    operations = [AddNode(node=Node(node_id=1, stamp_ns=2), features=FEATURES)]
    first.commit(operations)
    first.graph, first.revision = behind, revision  # as if the answer had not come
    behind.nodes.pop(1)
    with pytest.raises(RefusedError):
        first.commit(operations)
    assert len(stored(bus).nodes) == 2
    assert set(first.graph.nodes) == {0, 1}
