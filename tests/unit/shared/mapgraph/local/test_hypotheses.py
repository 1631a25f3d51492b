"""Matched nodes are grouped by where they put the picture."""

from shared.mapgraph.local.hypotheses import hypotheses
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


def test_nodes_that_the_map_does_not_have_say_nothing():
    assert places_of({99: claim(0.0, 0.0, 150)}) == []
