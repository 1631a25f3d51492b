"""Operations on a graph whose nodes are any values: what they write, what they refuse, and the order kept."""

import pytest

from shared.mapgraph import operations
from shared.mapgraph.operations import Draft, EdgeWrite, FullError, NodeWrite, TakenError, UnknownError
from shared.messages.maps import DeleteEdge, DeleteNode, Edge, PutEdge

AB, BC, AC = Edge(a=0, b=1), Edge(a=1, b=2), Edge(a=0, b=2)


def triangle() -> Draft[str]:
    return Draft({0: "a", 1: "b", 2: "c"}, {(0, 1): AB, (1, 2): BC, (0, 2): AC})


def test_every_write_says_what_was_there_before():
    draft, better = triangle(), Edge(a=0, b=1, inliers=9)
    draft.add(3, "d")
    draft.update(1, "B")
    draft.apply(PutEdge(edge=better))
    draft.apply(DeleteEdge(a=0, b=2))
    assert draft.writes == [
        NodeWrite(3, None, "d"),
        NodeWrite(1, "b", "B"),
        EdgeWrite((0, 1), AB, better),
        EdgeWrite((0, 2), AC, None),
    ]
    assert draft.nodes == {0: "a", 1: "B", 2: "c", 3: "d"}
    assert draft.edges == {(0, 1): better, (1, 2): BC}


def test_a_node_goes_after_its_edges():
    draft = triangle()
    draft.apply(DeleteNode(node_id=1))
    assert draft.writes == [
        EdgeWrite((0, 1), AB, None),
        EdgeWrite((1, 2), BC, None),
        NodeWrite(1, "b", None),
    ]


def test_what_is_replaced_keeps_its_place_in_the_order():
    draft = triangle()
    draft.update(0, "A")
    draft.apply(PutEdge(edge=Edge(a=0, b=1, inliers=9)))
    assert (list(draft.nodes), list(draft.edges)) == ([0, 1, 2], [(0, 1), (1, 2), (0, 2)])


def test_edges_joined_after_a_deletion_go_with_their_nodes_too():
    draft = triangle()
    draft.apply(DeleteNode(node_id=2))
    draft.add(3, "d")
    draft.apply(PutEdge(edge=Edge(a=0, b=3)))
    draft.apply(DeleteEdge(a=0, b=1))
    draft.apply(DeleteNode(node_id=0))
    assert (draft.nodes, draft.edges) == ({1: "b", 3: "d"}, {})


@pytest.mark.parametrize(
    ("wrong", "error", "text"),
    [
        pytest.param(lambda draft: draft.add(1, "x"), TakenError, "node 1 exists already", id="add"),
        pytest.param(lambda draft: draft.update(7, "x"), UnknownError, "node 7", id="update"),
        pytest.param(lambda d: d.apply(DeleteNode(node_id=7)), UnknownError, "node 7 does", id="delete"),
        pytest.param(lambda d: d.apply(PutEdge(edge=Edge(a=1, b=7))), UnknownError, "node 7", id="put edge"),
        pytest.param(lambda d: d.apply(DeleteEdge(a=1, b=7)), UnknownError, "edge 1-7", id="cut"),
    ],
)
def test_what_does_not_fit_is_refused_and_changes_nothing(wrong, error, text):
    draft = triangle()
    with pytest.raises(error, match=text):
        wrong(draft)
    assert (draft.nodes, draft.edges, draft.writes) == (triangle().nodes, triangle().edges, [])


def test_a_graph_grows_no_larger_than_a_message_about_it_may_be(monkeypatch):
    monkeypatch.setattr(operations, "MAX_CONTAINER", 3)
    draft = triangle()
    with pytest.raises(FullError, match="at most 3 nodes"):
        draft.add(3, "d")
    draft.nodes[3] = "d"
    draft.apply(PutEdge(edge=Edge(a=0, b=1, inliers=9)))
    with pytest.raises(FullError, match="at most 3 edges"):
        draft.apply(PutEdge(edge=Edge(a=0, b=3)))
