"""Comparing graphs: hand-made differences, and that rewinding gives what replaying from the start gives."""

from itertools import product

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.map_store.errors import ConflictError, CorruptError, MissingError
from services.map_store.history.comparison import EdgeChange, compare, rewind
from services.map_store.storage.graph import AddStoredNode, Graph, Step, StoredNode, apply
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, Node, PutEdge, UpdateNode
from tests.unit.services.map_store.storage.test_graph import NAMES, STEPS, TRIANGLE, edge, place


def after(*steps: Step) -> Graph:
    return apply(TRIANGLE, steps).graph


def test_equal_graphs_have_no_differences():
    found = compare(TRIANGLE, after())
    assert not any(vars(found).values())


def test_nodes_and_edges_are_told_as_added_and_the_other_way_round_as_removed():
    more = after(place(9), place(5), edge(2, 9), edge(0, 5))
    forth, back = compare(TRIANGLE, more), compare(more, TRIANGLE)
    assert (forth.nodes_added, forth.edges_added) == ((5, 9), ((0, 5), (2, 9)))
    assert (forth.nodes_removed, forth.edges_removed) == ((), ())
    assert (back.nodes_removed, back.edges_removed) == ((5, 9), ((0, 5), (2, 9)))
    assert (back.nodes_added, back.edges_added) == ((), ())


def test_deleting_a_node_removes_its_edges_and_changes_no_other():
    found = compare(TRIANGLE, after(DeleteNode(node_id=1)))
    assert (found.nodes_removed, found.edges_removed) == ((1,), ((0, 1), (1, 2)))
    assert (found.nodes_changed, found.edges_changed) == ((), ())


@pytest.mark.parametrize(
    "steps",
    [
        pytest.param([UpdateNode(node=Node(node_id=1, keypoints=9))], id="record"),
        pytest.param(
            [
                DeleteNode(node_id=1),
                AddStoredNode(place=StoredNode(node=Node(node_id=1), features="f1", thumbnail="new")),
                edge(0, 1),
                edge(1, 2),
            ],
            id="picture",
        ),
    ],
)
def test_a_node_of_both_with_another_record_or_picture_is_changed(steps: list[Step]):
    found = compare(TRIANGLE, after(*steps))
    assert found.nodes_changed == (1,)
    assert (found.nodes_added, found.nodes_removed, found.edges_changed) == ((), (), ())


def test_a_node_deleted_and_added_again_as_it_was_is_no_difference():
    found = compare(TRIANGLE, after(DeleteNode(node_id=1), place(1), edge(0, 1), edge(1, 2)))
    assert not any(vars(found).values())


def test_an_edge_of_both_tells_exactly_the_fields_that_differ():
    before = after(PutEdge(edge=Edge(a=0, b=1, inliers=40, confidence=0.5, clear=True, why="seen")))
    later = PutEdge(
        edge=Edge(
            a=0, b=1, inliers=40, confidence=0.25, clear=True, failures=2, suspended=True, why="blocked"
        )
    )
    assert compare(before, apply(before, [later]).graph).edges_changed == (
        EdgeChange(
            a=0,
            b=1,
            before={"confidence": 0.5, "failures": 0, "suspended": False, "why": "seen"},
            after={"confidence": 0.25, "failures": 2, "suspended": True, "why": "blocked"},
        ),
    )


def test_a_heading_that_is_gone_is_none_afterwards():
    before = after(PutEdge(edge=Edge(a=0, b=1, heading_ab_rad=0.5, yaw_ab_rad=1.0)))
    (change,) = compare(before, after(PutEdge(edge=Edge(a=0, b=1, yaw_ab_rad=1.0)))).edges_changed
    assert (change.before, change.after) == ({"heading_ab_rad": 0.5}, {"heading_ab_rad": None})


def test_a_way_back_that_belongs_to_another_graph_is_damage_and_not_a_missing_thing():
    for stray in (DeleteEdge(a=0, b=7), DeleteNode(node_id=7), place(1)):
        with pytest.raises(CorruptError, match="history does not fit the graph: operation 0"):
            rewind(TRIANGLE, [(stray,)])


Transactions = list[list[Step]]


@settings(max_examples=100, deadline=None)
@given(transactions=st.lists(st.lists(STEPS, min_size=1, max_size=6), max_size=8))
def test_any_two_revisions_compare_as_the_graphs_replayed_from_the_empty_map(transactions: Transactions):
    newest, inverses, replayed = Graph(), [], [Graph()]
    done: list[Step] = []
    for steps in transactions:
        try:
            change = apply(newest, steps)
        except (MissingError, ConflictError):
            continue
        newest = change.graph
        inverses.append(change.inverse)
        done += steps
        replayed.append(apply(Graph(), done).graph)
    rewound = [rewind(newest, reversed(inverses[revision:])) for revision in range(len(replayed))]
    for first, second in product(range(len(replayed)), repeat=2):
        assert vars(compare(rewound[first], rewound[second])) == brute(replayed[first], replayed[second])


def brute(before: Graph, after: Graph) -> dict[str, object]:
    """The same comparison, one possible node and edge after the other."""
    found: dict[str, list] = {
        f"{thing}_{how}": []
        for thing in ("nodes", "edges", "places", "rules", "routes", "signs")
        for how in ("added", "removed", "changed")
    }
    for name in NAMES:
        _note(found, "places", name, before.places.get(name), after.places.get(name))
        _note(found, "rules", name, before.rules.get(name), after.rules.get(name))
        _note(found, "routes", name, before.routes.get(name), after.routes.get(name))
        _note(found, "signs", name, before.signs.get(name), after.signs.get(name))
    for number in range(10):
        _note(found, "nodes", number, before.nodes.get(number), after.nodes.get(number))
    for key in product(range(10), repeat=2):
        _note(found, "edges", key, before.edges.get(key), after.edges.get(key))
    found["edges_changed"] = [
        # Of all fields, the steps of this test vary the inliers only.
        EdgeChange(*key, {"inliers": before.edges[key].inliers}, {"inliers": after.edges[key].inliers})
        for key in found["edges_changed"]
    ]
    return {name: tuple(values) for name, values in found.items()}


def _note(found: dict[str, list], thing: str, key: object, old: object, new: object) -> None:
    if old is None and new is not None:
        found[f"{thing}_added"].append(key)
    elif old is not None and new is None:
        found[f"{thing}_removed"].append(key)
    elif old != new:
        found[f"{thing}_changed"].append(key)
