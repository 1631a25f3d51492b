"""Matched nodes are grouped by where they put the picture; the likely places are named."""

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.hypotheses import hypotheses, is_plain, likely, typical_similarity
from tests.unit.shared.mapgraph.local.grid import claim, grid

GRAPH = grid(12, 2)


def places_of(claims):
    return hypotheses(GRAPH, claims)


ROUND_NODE_1 = {0: claim(-1.0, 0.0, 80), 1: claim(0.0, 0.0, 150), 13: claim(0.0, 1.0, 70)}


def test_nodes_of_one_place_are_one_hypothesis():
    [place] = places_of(ROUND_NODE_1)
    assert (set(place.nodes), place.similarity, place.support) == ({0, 1, 13}, 150, 300)


def test_a_look_alike_further_on_is_another():
    places = places_of({**ROUND_NODE_1, 9: claim(0.0, 0.0, 140), 10: claim(1.0, 0.0, 60)})
    assert [set(place.nodes) for place in places] == [{0, 1, 13}, {9, 10}]


def test_the_place_with_most_support_comes_first_though_one_node_resembles_more():
    places = places_of({**ROUND_NODE_1, 9: claim(0.0, 0.0, 200)})
    assert [place.similarity for place in places] == [150, 200]


def test_a_rival_makes_a_list_and_a_weak_one_does_not():
    assert len(likely(places_of({**ROUND_NODE_1, 9: claim(0.0, 0.0, 160)}))) == 2
    assert len(likely(places_of({**ROUND_NODE_1, 9: claim(0.0, 0.0, 140)}))) == 1


def test_a_place_whose_best_nodes_resemble_nearly_as_much_is_a_rival_of_one_with_more_nodes():
    """A goal in a hostel: in the wrong room a node stood nearer to the spot, and others around it."""
    dense = {node: claim(node - 2.0, 0.0, 90) for node in range(6)}
    sparse = {9: claim(0.0, 0.0, 120), 10: claim(1.0, 0.0, 70)}
    assert sum(c.similarity for c in sparse.values()) < 0.5 * sum(c.similarity for c in dense.values())
    assert len(likely(places_of({**dense, **sparse}))) == 2


def test_a_place_where_nodes_are_few_is_named_beside_one_where_they_are_many():
    """A goal in a hostel; the right room had two nodes among those compared."""
    dense = {node: claim(node - 2.0, 0.0, 100) for node in range(5)}
    rival = {6: claim(-1.0, 0.0, 150), 7: claim(0.0, 0.0, 150)}
    few = {11: claim(0.0, 0.0, 180)}
    places = likely(places_of({**dense, **rival, **few}))
    assert [set(place.nodes) for place in places] == [set(dense), set(rival), set(few)]


def test_a_place_alone_is_plain_where_it_resembles_as_much_as_itself():
    typical = typical_similarity(GRAPH)
    assert typical == 80
    assert is_plain(places_of(ROUND_NODE_1), typical)
    assert not is_plain(places_of({1: claim(0.0, 0.0, 90)}), typical)
    assert not is_plain([], typical)


def test_nodes_that_the_map_does_not_have_say_nothing():
    assert places_of({99: claim(0.0, 0.0, 150)}) == []
    assert typical_similarity(MapGraph()) == 0.0
