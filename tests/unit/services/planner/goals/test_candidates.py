"""The places where a picture can have been taken, and where a robot is relative to them."""

import numpy as np
import pytest

from services.planner.goals.candidates import Candidates
from services.planner.profiles import DEFAULT, THESIS
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.routing import GOAL
from shared.messages.matching import DIFFERENCES_SHAPE
from tests.unit.services.planner.travel.seen import Maps, by_node, match
from tests.unit.shared.mapgraph.local.grid import grid

GRAPH = grid(20, 2)
FIRST = by_node(match(1, 0.0, 0.0, 150), match(2, 1.0, 0.0, 80))
THIRD = by_node(match(17, 0.0, 0.0, 130), match(18, 1.0, 0.0, 80))
SECOND = by_node(match(9, 0.0, 0.0, 140), match(10, 1.0, 0.0, 80))
FAR = next(n for n in GRAPH.nodes if n not in GRAPH.nearest(1, 8))


def candidates_of(found, profile=DEFAULT):
    return Candidates(Maps(GRAPH), found, profile)


@pytest.mark.parametrize(
    ("found", "profile", "plain", "names"),
    [
        (FIRST, DEFAULT, True, "1"),
        (FIRST | SECOND, DEFAULT, False, "1, 9"),
        (by_node(match(1, 0.0, 0.0, 60), match(2, 1.0, 0.0, 40)), DEFAULT, False, "1"),
        (FIRST | SECOND, THESIS, True, ""),
    ],
    ids=["one", "two", "one that resembles it too little", "thesis"],
)
def test_it_is_plain_where_one_place_alone_resembles_the_picture(found, profile, plain, names):
    candidates = candidates_of(found, profile)
    assert (candidates.plain, candidates.names) == (plain, names)


def test_a_node_belongs_to_the_place_fewest_edges_off_where_that_is_in_doubt():
    places = candidates_of(FIRST | SECOND)
    assert [places.nearest(node).nodes[0] for node in (1, 3, 10, 12)] == [1, 1, 9, 9]
    assert places.nearest(None) is None
    assert candidates_of(FIRST).nearest(1) is None


def looked_at(differs):
    """The picture against nodes that differ from it by so many levels."""
    cells = {n: np.full(DIFFERENCES_SHAPE, levels, np.float32) for n, levels in differs.items()}
    return {n: match(n, 0.1, 0.0).model_copy(update={"differences": each}) for n, each in cells.items()}


def test_the_likeliest_place_is_that_whose_nodes_differ_least_as_pictures():
    """By the one that differs less of its nodes; what was not looked at comes last."""
    places = candidates_of(FIRST | SECOND | THIRD)
    assert places.to_look_at() == [1, 2, 9, 10, 17, 18]
    places.look(looked_at({9: 40.0, 10: 16.0, 17: 30.0}))
    assert places.names == "9, 17, 1"
    assert not places.unlikely


def test_a_place_whose_nodes_look_other_than_those_of_the_likeliest_is_unlikely():
    places = candidates_of(FIRST | SECOND | THIRD)
    places.look(looked_at({1: 20.0, 2: 90.0, 9: 59.0, 17: 61.0, 18: 80.0}))
    assert [place.nodes[0] for place in places.unlikely] == [17]


def test_where_no_node_was_near_enough_to_be_looked_at_the_places_stay_as_they_are():
    places = candidates_of(FIRST | SECOND)
    places.look(FIRST | SECOND)
    assert (places.names, places.unlikely) == ("1, 9", frozenset())


def test_who_is_within_reach_of_the_node_most_like_the_picture_stands_there():
    places = candidates_of(FIRST | SECOND)
    assert places.is_at(Displacement(9, x_m=0.3))
    assert not places.is_at(Displacement(9, y_m=1.5))
    assert not places.is_at(None)


def test_a_goal_in_sight_is_headed_for_beside_its_place_only():
    places = candidates_of(FIRST)
    assert [places.is_near(node) for node in (1, 3, 12, None)] == [True, True, False, True]


@pytest.mark.parametrize(("seen_m", "elsewhere"), [(4.8, False), (1.0, True)])
def test_a_goal_seen_where_its_place_is_not_is_not_headed_for(seen_m, elsewhere):
    """The next of equal desks, a period nearer."""
    places, goal = candidates_of(FIRST), match(GOAL, -seen_m, 0.0)
    assert places.is_elsewhere(goal, Displacement(FAR)) == elsewhere
    assert not places.is_elsewhere(goal, None)


def test_a_view_of_a_look_alike_is_no_arrival():
    places = candidates_of(FIRST)
    another = places.shows_another(SECOND, Displacement(9))
    assert another is not None
    assert another.nodes[0] == 9
    assert places.shows_another(FIRST, Displacement(1)) is None


@pytest.mark.parametrize(("node", "another"), [(2, False), (10, True)])
def test_a_view_that_may_be_of_either_is_believed_beside_the_place(node, another):
    rival = by_node(match(9, 0.0, 0.0, 160), match(10, 1.0, 0.0, 80))
    found = candidates_of(FIRST).shows_another(FIRST | rival, Displacement(node))
    assert (found is not None) == another


def test_a_view_like_the_place_from_further_off_than_its_matches_allow_is_of_another():
    """As at the next of equal desks: the nodes between the two are seen from both."""
    places = candidates_of(FIRST)
    assert places.shows_another(FIRST, None) is None
    assert places.shows_another(FIRST, Displacement(FAR)) is not None
