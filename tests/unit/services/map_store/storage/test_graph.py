"""The graph as a value: every operation, what it refuses, and that its inverse leads back."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from services.map_store.errors import ConflictError, InvalidError, MissingError
from services.map_store.storage.graph import AddStoredNode, Graph, Step, StoredNode, apply
from shared.mapgraph import operations
from shared.mapgraph.marks import nodes_of
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, Node, PutEdge, UpdateNode
from shared.messages.places import (
    DeletePlace,
    DeleteRoute,
    DeleteRule,
    KeepOut,
    OneWay,
    Place,
    PutPlace,
    PutRoute,
    PutRule,
    Route,
)


def place(number: int, stamp_ns: int = 0) -> AddStoredNode:
    return AddStoredNode(
        place=StoredNode(node=Node(node_id=number, stamp_ns=stamp_ns), features=f"f{number}")
    )


def edge(a: int, b: int, inliers: int = 0) -> PutEdge:
    return PutEdge(edge=Edge(a=a, b=b, inliers=inliers))


TRIANGLE = apply(Graph(), [place(0), place(1), place(2), edge(0, 1), edge(1, 2), edge(0, 2)]).graph


def test_steps_are_applied_in_order():
    assert set(TRIANGLE.nodes) == {0, 1, 2}
    assert set(TRIANGLE.edges) == {(0, 1), (1, 2), (0, 2)}


def test_the_graph_before_stays_as_it_was():
    apply(TRIANGLE, [DeleteNode(node_id=0)])
    assert set(TRIANGLE.nodes) == {0, 1, 2}
    with pytest.raises(TypeError):
        TRIANGLE.nodes[3] = place(3).place  # type: ignore[index]


def test_deleting_a_node_deletes_its_edges_and_no_other():
    change = apply(TRIANGLE, [DeleteNode(node_id=1)])
    assert set(change.graph.edges) == {(0, 2)}
    assert change.edges == {(0, 1), (1, 2)}
    assert change.nodes == {1}


def test_edges_put_after_the_first_deletion_are_deleted_with_their_node():
    steps = [DeleteNode(node_id=2), place(3), edge(0, 3), DeleteNode(node_id=3)]
    assert set(apply(TRIANGLE, steps).graph.edges) == {(0, 1)}


def test_putting_an_edge_again_replaces_it():
    change = apply(TRIANGLE, [edge(0, 1, inliers=42)])
    assert change.graph.edges[0, 1].inliers == 42
    assert len(change.graph.edges) == 3


def test_updating_a_node_keeps_its_pictures():
    change = apply(TRIANGLE, [UpdateNode(node=Node(node_id=1, keypoints=9))])
    assert change.graph.nodes[1].node.keypoints == 9
    assert change.graph.nodes[1].features == "f1"
    assert change.nodes == {1}
    assert change.inverse == (UpdateNode(node=Node(node_id=1)),)


@pytest.mark.parametrize(
    ("step", "error", "text"),
    [
        pytest.param(place(1), ConflictError, r"\(add_node\): node 1 exists already", id="node twice"),
        pytest.param(
            UpdateNode(node=Node(node_id=7)), MissingError, "node 7 does not exist", id="update nothing"
        ),
        pytest.param(DeleteNode(node_id=7), MissingError, "node 7 does not exist", id="delete nothing"),
        pytest.param(edge(7, 8), MissingError, "node 7 does not exist", id="edge from nowhere"),
        pytest.param(edge(1, 7), MissingError, "node 7 does not exist", id="edge to nowhere"),
        pytest.param(DeleteEdge(a=1, b=7), MissingError, "edge 1-7 does not exist", id="delete no edge"),
        pytest.param(place(2**63), InvalidError, "node id must be at most", id="id beyond the database"),
    ],
)
def test_steps_that_do_not_fit_are_refused_by_number_and_name(step: Step, error: type[Exception], text: str):
    with pytest.raises(error, match=f"operation 1 .*{text}"):
        apply(TRIANGLE, [edge(0, 1), step])


def test_a_full_map_takes_no_more(monkeypatch: pytest.MonkeyPatch):
    square = apply(TRIANGLE, [place(3)]).graph
    monkeypatch.setattr(operations, "MAX_CONTAINER", 3)
    with pytest.raises(InvalidError, match="at most 3 nodes"):
        apply(TRIANGLE, [place(3)])
    with pytest.raises(InvalidError, match="at most 3 edges"):
        apply(square, [edge(0, 1, inliers=1), edge(0, 3)])


IDS = st.integers(0, 4)
NAMES = ("dock", "hall")
NAMED = st.sampled_from(NAMES)
LISTED = st.lists(IDS, max_size=3).map(tuple)
MARKS = st.one_of(
    st.builds(lambda name, nodes: PutPlace(place=Place(name=name, nodes=nodes)), NAMED, LISTED),
    st.builds(
        lambda name, nodes, areas: PutRule(rule=KeepOut(name=name, nodes=nodes, areas=tuple(areas))),
        NAMED,
        LISTED,
        st.lists(NAMED, max_size=1),
    ),
    st.builds(lambda name, a: PutRule(rule=OneWay(name=name, edges=((a, a + 1),))), NAMED, st.integers(0, 3)),
    st.builds(lambda name, nodes: PutRoute(route=Route(name=name, nodes=nodes)), NAMED, LISTED),
    st.builds(lambda name: DeletePlace(name=name), NAMED),
    st.builds(lambda name: DeleteRoute(name=name), NAMED),
    st.builds(lambda name: DeleteRule(name=name), NAMED),
)
STEPS = st.one_of(
    st.builds(place, IDS, st.integers(0, 9)),
    st.builds(
        lambda number, stamp: UpdateNode(node=Node(node_id=number, stamp_ns=stamp)), IDS, st.integers(0, 9)
    ),
    st.builds(lambda number: DeleteNode(node_id=number), IDS),
    st.builds(lambda a, more, inliers: edge(a, a + more, inliers), IDS, st.integers(1, 3), st.integers(0, 9)),
    st.builds(lambda a, more: DeleteEdge(a=a, b=a + more), IDS, st.integers(1, 3)),
    MARKS,
)


@settings(max_examples=200, deadline=None)
@given(steps=st.lists(STEPS, max_size=30))
def test_whatever_was_done_the_inverse_leads_back_and_every_edge_has_both_ends(steps: list[Step]):
    fitting: list[Step] = []
    for step in steps:
        try:
            apply(TRIANGLE, [*fitting, step])
        except (MissingError, ConflictError):
            continue
        fitting.append(step)
    change = apply(TRIANGLE, fitting)
    assert all(end in change.graph.nodes for key in change.graph.edges for end in key)
    back = apply(change.graph, change.inverse).graph
    assert dict(back.nodes) == dict(TRIANGLE.nodes)
    assert dict(back.edges) == dict(TRIANGLE.edges)
    assert back.marks == TRIANGLE.marks
    after = change.graph
    marks = (*after.places.values(), *after.rules.values(), *after.routes.values())
    listed = [n for mark in marks for n in nodes_of(mark)]
    assert set(listed) <= change.graph.nodes.keys()
