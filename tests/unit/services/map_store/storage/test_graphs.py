"""Which graphs are kept in memory: those used last, as many as there is room for."""

import pytest

from services.map_store.storage import graphs
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.graph import Graph, StoredNode
from services.map_store.storage.graphs import Graphs
from shared.messages.maps import Node


def of_nodes(count: int) -> Graph:
    return Graph({n: StoredNode(node=Node(node_id=n), features="", thumbnail="") for n in range(count)})


@pytest.fixture
def read(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """The maps that were read from the database, which here are all empty."""
    asked: list[int] = []

    def read_graph(_connection: object, found: MapRecord) -> Graph:
        asked.append(found.map_id)
        return Graph()

    monkeypatch.setattr(graphs, "read_graph", read_graph)
    return asked


def record(map_id: int, revision: int = 1) -> MapRecord:
    return MapRecord(map_id, f"m{map_id}", revision, 0, 0)


def test_the_one_used_longest_ago_makes_room(read, monkeypatch):
    monkeypatch.setattr(graphs, "CACHED_ELEMENTS", 30)
    kept = Graphs()
    for map_id in (1, 2):
        kept.remember(map_id, 1, of_nodes(9))
    kept.get(None, record(1))
    kept.remember(3, 1, of_nodes(15))
    assert [len(kept.get(None, record(map_id)).nodes) for map_id in (1, 3, 2)] == [9, 15, 0]
    assert read == [2]


def test_what_grows_counts_once_and_one_is_kept_however_large(read, monkeypatch):
    monkeypatch.setattr(graphs, "CACHED_ELEMENTS", 30)
    kept = Graphs()
    for revision in range(1, 10):
        kept.remember(1, revision, of_nodes(10))
        kept.remember(2, revision, of_nodes(10))
    assert [len(kept.get(None, record(map_id, 9)).nodes) for map_id in (1, 2)] == [10, 10]
    kept.remember(3, 1, of_nodes(99))
    assert len(kept.get(None, record(3)).nodes) == 99
    assert read == []
    kept.forget(3)
    kept.remember(1, 9, of_nodes(29))
    assert len(kept.get(None, record(1, 9)).nodes) == 29
    assert read == []


def test_another_revision_is_read_and_an_older_one_not_kept(read):
    kept = Graphs()
    kept.remember(1, 5, of_nodes(3))
    kept.remember(1, 4, of_nodes(2))
    assert len(kept.get(None, record(1, 5)).nodes) == 3
    assert kept.get(None, record(1, 6)).nodes == {}
    assert read == [1]
