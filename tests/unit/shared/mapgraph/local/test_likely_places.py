"""Of the places that a picture resembles the likely ones are named."""

from dataclasses import replace

import pytest

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.hypotheses import hypotheses
from shared.mapgraph.local.likely_places import is_plain, likely, typical_similarity
from shared.mapgraph.local.view_range import similarity_at
from tests.unit.shared.mapgraph.local.grid import claim, grid

GRAPH = grid(12, 2)
ROUND_NODE_1 = {0: claim(-1.0, 0.0, 80), 1: claim(0.0, 0.0, 150), 13: claim(0.0, 1.0, 70)}


def places_of(claims):
    return likely(GRAPH, claims, hypotheses(GRAPH, claims))


def seen_from(x_m, y_m, nodes, share=1.0):
    """What a picture taken there would claim of nodes, or that share of the matches."""
    places = {node: (node % 12 - x_m, node // 12 - y_m) for node in nodes}
    return {
        node: claim(ahead, aside, round(share * similarity_at(GRAPH, node, (ahead**2 + aside**2) ** 0.5)))
        for node, (ahead, aside) in places.items()
    }


def test_a_rival_makes_a_list_and_a_weak_one_does_not():
    assert len(places_of({**ROUND_NODE_1, 9: claim(0.0, 0.0, 160)})) == 2
    assert len(places_of({**ROUND_NODE_1, 9: claim(0.0, 0.0, 140)})) == 1


def test_a_place_whose_best_nodes_resemble_nearly_as_much_is_a_rival_of_one_with_more_nodes():
    """A goal in a hostel: in the wrong room a node stood nearer to the spot, and others around it."""
    dense = {node: claim(node - 2.0, 0.0, 90) for node in range(6)}
    sparse = {9: claim(0.0, 0.0, 120), 10: claim(1.0, 0.0, 70)}
    assert sum(c.similarity for c in sparse.values()) < 0.5 * sum(c.similarity for c in dense.values())
    assert len(places_of({**dense, **sparse})) == 2


def test_a_place_where_nodes_are_few_is_named_beside_one_where_they_are_many():
    """A goal in a hostel; the right room had two nodes among those compared."""
    dense = {node: claim(node - 2.0, 0.0, 100) for node in range(5)}
    rival = {6: claim(-1.0, 0.0, 150), 7: claim(0.0, 0.0, 150)}
    few = {11: claim(0.0, 0.0, 180)}
    places = places_of({**dense, **rival, **few})
    assert [set(place.nodes) for place in places] == [set(dense), set(rival), set(few)]


def test_a_place_alone_is_plain_where_it_resembles_as_much_as_itself():
    typical = typical_similarity(GRAPH)
    assert typical == 80
    assert is_plain(places_of(ROUND_NODE_1), typical)
    assert not is_plain(places_of({1: claim(0.0, 0.0, 90)}), typical)
    assert not is_plain([], typical)


def test_a_place_all_of_whose_nodes_see_the_picture_one_way_is_none_beside_one_whose_bearings_cross():
    """A goal in a yard, and nodes in a far corner of it: parallel, and by their matches two metres away."""
    crossing = {0: claim(-1.0, -0.5, 70), 1: claim(0.0, -0.5, 80), 13: claim(0.0, 0.5, 70)}
    parallel = {node: claim(2.0, 0.1, 75) for node in (8, 9, 20, 21)}
    assert [set(place.nodes) for place in places_of({**crossing, **parallel})] == [set(crossing)]
    assert [set(place.nodes) for place in places_of(parallel)] == [set(parallel)], "one alone is named"


@pytest.mark.parametrize(("similarity", "named"), [(40, {0, 1, 13}), (100, {9})])
def test_one_node_taken_for_near_does_not_outdo_a_place_with_far_more_matches(similarity, named):
    """Of the right place only what is far away moved: 190 matches in its core."""
    right = {0: claim(-1.0, -0.5, 60), 1: claim(0.0, -0.5, 70), 13: claim(0.0, 0.5, 60)}
    far = {node: replace(seen, is_near=False) for node, seen in right.items()}
    assert [set(place.nodes) for place in places_of({**far, 9: claim(1.0, 0.0, similarity)})] == [named]


def test_of_a_place_seen_from_near_only_what_shows_it_from_there_outdoes_others():
    right = {0: claim(-1.0, -0.5, 60), 1: claim(0.0, -0.5, 70), 13: claim(0.0, 0.5, 60)}
    far = {node: replace(seen, is_near=False) for node, seen in right.items()}
    mostly_far = {9: replace(claim(1.0, 0.0, 80), is_near=False), 10: claim(2.0, 0.0, 23)}
    assert set(right) in [set(place.nodes) for place in places_of({**far, **mostly_far})]


def test_a_twin_whose_nodes_stand_nearer_to_the_spot_is_none_where_it_lacks_matches():
    """The right place is half a metre from its nodes; a twin at the very spot of one has as many matches."""
    right = seen_from(1.5, 0.5, (1, 2, 13, 14))
    twin = seen_from(9.0, 0.0, (8, 9, 10, 21), share=0.55)
    assert sum(c.similarity for c in twin.values()) > 0.5 * sum(c.similarity for c in right.values())
    [place] = places_of({**right, **twin})
    assert set(place.nodes) == set(right)


def test_a_twin_that_has_what_would_be_expected_of_it_is_a_rival():
    right, twin = seen_from(1.5, 0.5, (1, 2, 13, 14)), seen_from(9.0, 0.0, (8, 9, 10, 21))
    assert len(places_of({**right, **twin})) == 2


def test_a_place_with_more_matches_than_expected_excludes_none_that_has_most_of_its_own():
    """Clouds over a yard: nodes of the other end agree with the picture, beyond what is near them."""
    right = seen_from(1.5, 0.5, (1, 2, 13, 14), share=0.8)
    clouds = seen_from(9.0, 5.0, (8, 9, 10, 20, 21, 22), share=1.6)
    assert {place.nodes[0] for place in places_of({**right, **clouds})} >= {1}


def test_a_place_of_which_only_what_is_far_away_shows_is_none_beside_one_seen_from_near():
    right = {1: claim(0.5, 0.0, 70), 2: claim(1.5, 0.0, 40)}
    clouds = {node: replace(claim(node - 8.0, 2.0, 60), is_near=False) for node in range(7, 12)}
    [place] = places_of({**right, **clouds})
    assert set(place.nodes) == set(right)
    assert places_of(clouds)


def test_a_map_without_driven_ways_has_no_typical_similarity():
    assert typical_similarity(MapGraph()) == 0.0
