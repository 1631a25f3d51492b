"""Revisions in a few words, read once and kept, and a damaged one does not hide the others."""

import pytest
from sqlalchemy import update

from services.map_store.history import summaries
from services.map_store.history.summaries import summarise
from services.map_store.storage import tables
from services.map_store.storage.graph import Step, apply
from services.map_store.storage.rows import STEPS
from services.map_store.store import MapStore
from shared.messages.maps import DeleteEdge, DeleteNode, Node, UpdateNode
from tests.unit.services.map_store.conftest import add
from tests.unit.services.map_store.storage.test_graph import TRIANGLE, edge, place


def said(*steps: Step) -> str:
    inverse = apply(TRIANGLE, steps).inverse
    return summarise(STEPS.dump_python(steps), STEPS.dump_python(inverse))


@pytest.mark.parametrize(
    ("steps", "words"),
    [
        pytest.param([place(12)], "node 12 added", id="one node"),
        pytest.param(
            [place(12), edge(0, 12), edge(1, 12), edge(2, 12)], "node 12 added, 3 edges put", id="node, edges"
        ),
        pytest.param([place(7), place(8)], "2 nodes added", id="two nodes"),
        pytest.param([edge(0, 1, 5)], "edge 0-1 put", id="one edge"),
        pytest.param([edge(0, 1, 5), edge(0, 1, 6)], "edge 0-1 put", id="one edge twice"),
        pytest.param([DeleteEdge(a=1, b=2)], "edge 1-2 deleted", id="edge gone"),
        pytest.param([UpdateNode(node=Node(node_id=2))], "node 2 updated", id="update"),
        pytest.param([DeleteNode(node_id=1)], "node 1 deleted with 2 edges", id="node with its edges"),
        pytest.param(
            [DeleteNode(node_id=1), DeleteNode(node_id=2)],
            "2 nodes deleted with 3 edges",
            id="two nodes gone",
        ),
        pytest.param(
            [DeleteEdge(a=0, b=1), DeleteNode(node_id=1)],
            "node 1 deleted with 1 edge, edge 0-1 deleted",
            id="an edge deleted by name counts once",
        ),
        pytest.param(
            [place(9), DeleteNode(node_id=9)], "node 9 added, node 9 deleted", id="no edges to lose"
        ),
    ],
)
def test_a_revision_is_told_by_what_its_steps_did(steps: list[Step], words: str):
    assert said(*steps) == words


def told(store: MapStore) -> list[str]:
    return [entry.summary for entry in store.revisions("flat", 2**62, 100)]


def test_an_undo_tells_what_it_did_to_the_map(store: MapStore):
    store.transact("flat", [add(0), add(1), edge(0, 1)])
    store.transact("flat", [DeleteNode(node_id=0)])
    store.undo("flat")
    assert told(store) == [
        "node 0 added, edge 0-1 put",
        "node 0 deleted with 1 edge",
        "2 nodes added, edge 0-1 put",
    ]


def test_steps_are_read_once_and_not_again(store: MapStore, monkeypatch: pytest.MonkeyPatch):
    for number in range(5):
        store.transact("flat", [add(number)])
    read, reads = summaries.read_history, []
    monkeypatch.setattr(summaries, "read_history", lambda *row: reads.append(row) or read(*row))
    first = told(store)
    assert len(reads) == 5
    store.transact("flat", [add(9)])
    assert told(store) == ["node 9 added", *first]
    assert len(reads) == 6


def test_the_cache_lets_the_oldest_go(store: MapStore, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(summaries, "CACHED", 2)
    for number in range(5):
        store.transact("flat", [add(number)])
    assert told(store) == [f"node {number} added" for number in (4, 3, 2, 1, 0)]
    assert len(store._summaries._summaries) == 2


def test_a_damaged_revision_says_so_and_the_others_are_listed(store: MapStore):
    store.transact("flat", [add(0)])
    store.transact("flat", [add(2)])
    with store.database.write() as connection:
        table = tables.revisions
        connection.execute(update(table).where(table.c.revision == 1).values(content=b"\x80"))
    assert told(store) == ["node 2 added", "unreadable: the stored operations do not match their checksum"]
