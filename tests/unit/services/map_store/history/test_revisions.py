"""Older revisions out of a real history: undos, restores and renames in it, damage told as such."""

from itertools import product

import pytest
from sqlalchemy import delete, select, update

from services.map_store.errors import CorruptError, MissingError
from services.map_store.history.comparison import Comparison, compare
from services.map_store.storage import tables
from services.map_store.storage.graph import AddStoredNode, Graph, apply
from services.map_store.storage.rows import STEPS, read_history
from services.map_store.store import MapStore
from shared.messages.maps import DeleteEdge, DeleteNode, Node, UpdateNode
from tests.unit.services.map_store.conftest import add
from tests.unit.services.map_store.storage.test_graph import edge


@pytest.fixture
def lived(store: MapStore) -> MapStore:
    """A map of eight revisions in which everything happens that can happen."""
    store.transact("flat", [add(0), add(1), add(2), edge(0, 1), edge(1, 2)])
    store.transact("flat", [edge(0, 1, inliers=7), UpdateNode(node=Node(node_id=2, keypoints=9))])
    store.transact("flat", [DeleteNode(node_id=1)])
    store.undo("flat")
    store.transact("flat", [add(3), edge(2, 3), DeleteEdge(a=0, b=1)])
    store.undo("flat")
    store.undo("flat")
    store.rename("flat", "house")
    store.transact("house", [DeleteNode(node_id=0), add(0), edge(0, 2)])
    return store


def replayed(store: MapStore, name: str) -> list[Graph]:
    """The graph of every revision, forwards from the empty map."""
    with store.database.read() as connection:
        table, maps = tables.revisions.c, tables.maps.c
        chosen = table.map_id == select(maps.map_id).where(maps.name == name).scalar_subquery()
        rows = connection.execute(
            select(table.content, table.sha256).where(chosen).order_by(table.revision)
        ).all()
    graphs = [Graph()]
    for row in rows:
        steps = STEPS.validate_python(read_history(*row)["steps"])
        graphs.append(apply(graphs[-1], steps).graph)
    return graphs


def test_any_two_revisions_compare_as_the_history_replayed_forwards(lived: MapStore):
    graphs = replayed(lived, "house")
    assert len(graphs) == 9
    for start, end in product(range(9), repeat=2):
        assert lived.compare("house", start, end) == (end, compare(graphs[start], graphs[end]))


def test_the_newest_revision_is_the_end_when_none_is_given(lived: MapStore):
    assert lived.compare("house", 3, None) == lived.compare("house", 3, 8)


def test_a_restored_map_starts_empty(store: MapStore):
    store.transact("flat", [add(0)])
    place = store.graph("flat")[1].nodes[0]
    store.restore("copy", (AddStoredNode(place=place),), lambda _: b"bytes", "rest")
    assert store.compare("copy", 0, None) == (1, Comparison((0,), (), (), (), (), ()))


@pytest.mark.parametrize(("start", "end"), [(9, None), (0, 9), (9, 0), (-1, 3), (2**63 - 1, None)])
def test_a_revision_that_is_not_there_is_named_with_those_that_are(
    lived: MapStore, start: int, end: int | None
):
    with pytest.raises(MissingError, match=r"map 'house': revision \S+ does not exist; revisions: 0 to 8"):
        lived.compare("house", start, end)


def test_damage_on_the_way_back_is_told_and_does_not_touch_newer_revisions(lived: MapStore):
    table = tables.revisions
    with lived.database.write() as connection:
        connection.execute(update(table).where(table.c.revision == 5).values(content=b"\x80"))
    assert lived.compare("house", 5, 8)[0] == 8
    with pytest.raises(CorruptError, match="revision 5: the stored operations do not match"):
        lived.compare("house", 4, 8)


def test_a_gap_in_the_history_is_damage(lived: MapStore):
    table = tables.revisions
    with lived.database.write() as connection:
        connection.execute(delete(table).where(table.c.revision == 5))
    with pytest.raises(CorruptError, match="revision 5: its record is missing"):
        lived.compare("house", 4, 8)
