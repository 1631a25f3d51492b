"""Which of several places that look alike the goal is: each is visited, arrival excludes the others."""

import numpy as np
import pytest

from services.planner.goals.candidates import Candidates
from services.planner.goals.place_evidence import Visit
from services.planner.goals.places import GoalPlaces
from services.planner.look_alikes import LookAlikes
from services.planner.profiles import DEFAULT, THESIS
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.routing import GOAL
from shared.messages.matching import DIFFERENCES_SHAPE
from tests.unit.services.planner.travel.seen import Maps, by_node, match
from tests.unit.shared.mapgraph.local.grid import grid

GRAPH = grid(20, 2)
FIRST = by_node(match(1, 0.0, 0.0, 150), match(2, 1.0, 0.0, 80))
SECOND = by_node(match(9, 0.0, 0.0, 140), match(10, 1.0, 0.0, 80))
THIRD = by_node(match(17, 0.0, 0.0, 140), match(18, 1.0, 0.0, 80))
FOURTH = by_node(match(25, 0.0, 0.0, 140), match(26, 1.0, 0.0, 80))
TARGETS = dict.fromkeys((1, 2, 9, 10, 17, 18), 0.1)


def view(likeness):
    return Visit(round(230 * likeness), likeness)


def places_of(found, profile=DEFAULT, known=None):
    return GoalPlaces(Candidates(Maps(GRAPH), found, profile), known or LookAlikes())


def look(places, node, differs):
    seen = match(GOAL, 0.1, 0.0).model_copy(
        update={"differences": np.full(DIFFERENCES_SHAPE, differs, np.float32)}
    )
    places.sees(seen, Displacement(node, x_m=0.1))


@pytest.fixture
def two():
    return places_of(FIRST | SECOND)


def test_a_place_without_rivals_is_arrived_at_at_once():
    places = places_of(FIRST)
    assert places.arrived(2, view(0.40)).why == ""
    assert set(places.open_targets(TARGETS)) == {1, 2}


def test_who_stood_at_the_very_spot_and_did_not_see_the_goal_excludes_it(two):
    two.stood(9)
    assert two.arrived(1, view(0.86)).why == ""


def test_the_one_place_that_there_is_gets_another_try():
    """It resembles the goal too little to be plain."""
    places = places_of(by_node(match(1, 0.0, 0.0, 60), match(2, 1.0, 0.0, 40)))
    assert places.stood(1).failure == ""
    assert set(places.open_targets(TARGETS)) == {1, 2}
    assert places.stood(1).failure == "goal_not_in_map"


def test_a_look_alike_is_visited_before_arrival_is_claimed(two):
    assert set(two.open_targets(TARGETS)) == {1, 2, 9, 10}
    assert "not excluded" in two.arrived(2, view(0.88)).why
    assert set(two.open_targets(TARGETS)) == {9, 10}
    assert "another place" in two.arrived(10, view(0.48)).why
    assert set(two.open_targets(TARGETS)) == {1, 2}
    assert two.arrived(1, view(0.86)).why == ""


def test_the_last_one_visited_may_be_it(two):
    two.arrived(2, view(0.48))
    assert two.arrived(9, view(0.88)).why == ""


def test_a_place_that_was_not_reached_is_not_excluded(two):
    two.arrived(2, view(0.88))
    assert two.blocked(9).failure == ""
    ruling = two.blocked(9)
    assert ruling.failure == "ambiguous"
    assert "9 could not be reached" in ruling.why


def test_after_a_place_that_was_not_reached_the_others_are_tried(two):
    two.blocked(9)
    assert two.blocked(9).why.endswith("not excluded"), "no differences are known of places nobody was at"
    assert set(two.open_targets(TARGETS)) == {1, 2}
    assert two.arrived(2, view(0.88)).failure == "ambiguous"


def test_a_goal_that_none_of_the_places_seen_resembles_may_be_at_the_one_not_reached(two):
    two.arrived(2, view(0.48))
    two.blocked(9)
    assert two.blocked(9).failure == "blocked"


def shut(places, node):
    rulings = [places.way_failed(waypoint) for waypoint in (node, node + 1, node, node + 1)]
    assert rulings[:3] == [None] * 3
    return rulings[3]


def test_a_place_to_whose_nodes_four_ways_failed_is_shut(two):
    assert two.way_failed(12) is None
    assert shut(two, 9).why.startswith("4 ways to node 9 failed; 1 places")
    assert set(two.open_targets(TARGETS)) == {1, 2}
    assert two.way_failed(9) is None


def test_one_place_not_reached_leaves_no_doubt_where_two_others_are_excluded():
    places = places_of(FIRST | SECOND | THIRD | FOURTH)
    places.arrived(1, view(0.88))
    places.arrived(9, view(0.48))
    places.arrived(17, view(0.48))
    ruling = shut(places, 25)
    assert ruling.failure == ""
    assert "another place" in ruling.why
    assert set(places.open_targets(TARGETS)) == {1, 2}
    assert places.arrived(1, view(0.86)).why == ""


def test_it_leaves_a_doubt_where_one_other_is_excluded():
    places = places_of(FIRST | SECOND | THIRD)
    places.arrived(1, view(0.88))
    places.arrived(9, view(0.48))
    assert shut(places, 17).failure == "ambiguous"


def test_places_that_resemble_it_equally_are_ambiguous(two):
    two.arrived(2, view(0.88))
    ruling = two.arrived(9, view(0.84))
    assert ruling.failure == "ambiguous"
    assert "1, 9" in ruling.why


def test_two_that_are_both_little_alike_do_not_end_the_search_for_a_third():
    places = places_of(FIRST | SECOND | THIRD)
    places.arrived(1, view(0.61))
    assert places.arrived(9, view(0.60)).failure == ""
    assert places.arrived(17, view(0.88)).why == ""


def test_places_are_compared_by_matches_not_by_what_two_frames_there_shared(two):
    """At the spot the robot stood nearly still, and two frames shared more."""
    two.arrived(9, Visit(132, 0.72))
    assert two.arrived(1, Visit(199, 0.88)).why == ""


def test_rooms_with_equal_matches_are_told_apart_by_how_much_they_differ_as_pictures(two):
    look(two, 9, 26.0)
    look(two, 1, 8.0)
    two.arrived(9, view(0.88))
    assert two.arrived(1, view(0.86)).why == ""


def test_a_place_where_it_was_lost_once_is_not_gone_to_again_once_another_differs_far_less(two):
    look(two, 9, 42.0)
    assert two.lost(9).why == "not seen"
    assert set(two.open_targets(TARGETS)) == {1, 2, 9, 10}, "nothing to compare it with"
    look(two, 1, 3.0)
    assert two.arrived(1, view(0.90)).why == ""


@pytest.mark.parametrize(("lost", "differs"), [(False, 60.0), (True, 8.0), (True, None)])
def test_it_is_where_it_was_not_lost_or_differs_little_or_was_not_seen_from_near(two, lost, differs):
    if differs is not None:
        look(two, 9, differs)
    if lost:
        two.lost(9)
    look(two, 1, 15.0)
    assert "1 places that look alike are not excluded" in two.arrived(1, view(0.90)).why


@pytest.fixture
def in_doubt(two):
    """Both places visited: from the first the goal differs less, but not by enough."""
    look(two, 1, 11.0)
    two.arrived(1, view(0.88))
    look(two, 9, 26.0)
    ruling = two.arrived(9, view(0.84))
    assert "1: 11, 9: 26" in ruling.why
    assert not ruling.failure
    return two


def test_where_the_visits_do_not_tell_the_place_that_differs_least_is_looked_at_again(in_doubt):
    assert in_doubt.looks_again
    assert set(in_doubt.open_targets(TARGETS)) == {1, 2}
    look(in_doubt, 1, 6.0)
    assert in_doubt.arrived(1, view(0.90)).why == ""
    assert not in_doubt.looks_again


def test_who_stays_in_doubt_after_another_look_says_so(in_doubt):
    assert in_doubt.arrived(1, view(0.88)).failure == "ambiguous"


@pytest.mark.parametrize("missed", [GoalPlaces.lost, GoalPlaces.blocked])
def test_a_place_not_reached_for_another_look_leaves_the_doubt(in_doubt, missed):
    rulings = [missed(in_doubt, 1) for _ in range(2)]
    assert [each.failure for each in rulings] == ["", "ambiguous"]
    assert "look alike" in rulings[1].why


def test_an_arrival_that_was_none_counts_at_the_spot_and_near_by_the_second_time(two):
    assert "not there" in two.refuted(Displacement(9, y_m=1.5)).why
    assert "not there" in two.refuted(Displacement(6)).why
    assert "not there" in two.refuted(None).why
    assert set(two.open_targets(TARGETS)) == {1, 2, 9, 10}
    two.refuted(Displacement(9, y_m=1.5))
    assert set(two.open_targets(TARGETS)) == {1, 2}
    two.refuted(Displacement(1, x_m=0.3))
    assert set(two.open_targets(TARGETS)) != {1, 2, 9, 10}


def test_a_place_that_no_way_leads_to_is_named(two):
    assert two.without({1: 0.1, 10: 0.2}) == []
    assert two.without({1: 0.1}) == [9]


def test_a_goal_at_none_of_the_places_is_not_in_the_map(two):
    two.arrived(2, view(0.44))
    assert two.arrived(9, view(0.40)).failure == "goal_not_in_map"


def test_in_a_bare_corridor_it_is_at_the_one_place_that_fits_as_a_picture():
    places = places_of(by_node(match(1, 0.0, 0.0, 60), match(2, 1.0, 0.0, 40)))
    assert stand(places, 1, 12.0, likeness=0.46).failure == "goal_not_in_map"
    assert stand(places, 1, 6.5, likeness=0.46).why == ""


def test_a_place_where_the_picture_is_lost_twice_is_excluded(two):
    assert two.arrived(2, view(0.88)).why
    assert two.lost(9).failure == ""
    assert "another place" in two.lost(9).why
    assert set(two.open_targets(TARGETS)) == {1, 2}


def test_the_thesis_knows_no_rivals():
    places = places_of(FIRST | SECOND, THESIS)
    assert set(places.open_targets(TARGETS)) == set(TARGETS)


def stand(places, node, differs, likeness=0.88):
    look(places, node, differs)
    return places.arrived(node, view(likeness))


def test_where_many_were_told_apart_before_the_first_that_fits_as_well_as_a_right_one_is_it():
    known = LookAlikes([27.0] * 14)
    places = places_of(FIRST | SECOND | THIRD, known=known)
    costs = places.open_targets(TARGETS | {1: 90.0, 2: 90.0})
    assert max(costs[1], costs[2]) < min(cost for node, cost in costs.items() if node > 2)
    assert stand(places, 1, 6.0).why == ""


@pytest.mark.parametrize("known", [LookAlikes([27.0] * 14, equal=4), LookAlikes([27.0] * 14 + [11.0])])
def test_with_equal_ones_or_too_large_a_difference_each_is_visited(known):
    places = places_of(FIRST | SECOND | THIRD, known=known)
    assert stand(places, 1, 6.0).why.startswith("88% alike; 2 places")


@pytest.mark.parametrize(("differs", "settled"), [(6.0, True), (8.0, False)])
def test_of_a_few_places_the_first_that_fits_closely_is_it_in_a_new_building_too(differs, settled):
    ruling = stand(places_of(FIRST | SECOND | THIRD), 1, differs)
    assert (ruling.why == "") == settled


@pytest.fixture
def nearly():
    """Three places, the first of which nearly fits from where the robot arrived."""
    places = places_of(FIRST | SECOND | THIRD, known=LookAlikes([27.0] * 14))
    assert "from nearer by" in stand(places, 1, 9.0).why
    assert places.looks_again
    return places


def costs_by_place(places):
    """The most and the least that a target costs, of the first place and of the others."""
    costs = places.open_targets(TARGETS)
    first, others = [costs.get(n) for n in (1, 2)], [costs[n] for n in (9, 10, 17, 18)]
    return first, min(others)


def test_a_place_that_nearly_fits_is_looked_at_from_nearer_by_before_the_others(nearly):
    first, others = costs_by_place(nearly)
    assert max(first) < others
    assert stand(nearly, 1, 6.0).why == ""
    assert not nearly.looks_again


def test_one_that_does_not_fit_from_nearer_by_either_is_left_for_the_others(nearly):
    assert "2 places that look alike" in stand(nearly, 1, 9.0).why
    assert not nearly.looks_again
    assert costs_by_place(nearly)[0] == [None, None]


def test_one_that_is_not_seen_from_nearer_by_is_left_for_the_others_as_it_was(nearly):
    nearly.lost(1)
    nearly.lost(1)
    assert not nearly.looks_again
    assert costs_by_place(nearly)[0] == [None, None]
    for node in (9, 17):
        ruling = stand(nearly, node, 40.0, likeness=0.7)
    assert "another place resembles the goal more" in ruling.why


def test_who_comes_to_another_place_first_looks_at_none_again(nearly):
    stand(nearly, 9, 40.0)
    assert not nearly.looks_again


@pytest.mark.parametrize("differs", [6.0, 20.0])
def test_a_place_that_fits_or_differs_by_far_is_not_looked_at_from_nearer_by(differs):
    places = places_of(FIRST | SECOND | THIRD, known=LookAlikes([27.0] * 14, equal=4))
    assert "2 places that look alike" in stand(places, 1, differs).why
    assert not places.looks_again


def test_a_place_that_hardly_resembles_the_goal_is_not_it_however_many_were_told_apart():
    places = places_of(FIRST | SECOND | THIRD, known=LookAlikes([27.0] * 14))
    assert stand(places, 1, 6.0, likeness=0.5).why.startswith("50% alike; 2 places")


def four_places(unlikely):
    """Where one of three places that nobody saw may be equal, but for those whose nodes look other."""
    candidates = Candidates(Maps(GRAPH), FIRST | SECOND | THIRD | FOURTH, DEFAULT)
    candidates.unlikely = frozenset(candidates.places[4 - unlikely :])
    return GoalPlaces(candidates, LookAlikes(equal=1))


def test_a_place_whose_nodes_look_other_than_those_of_the_likeliest_comes_last():
    costs = four_places(unlikely=2).open_targets(TARGETS | {1: 90.0, 9: 90.0, 25: 0.1})
    assert max(costs[1], costs[9]) < min(costs[17], costs[25])


@pytest.mark.parametrize(("unlikely", "left"), [(2, 0), (0, 3)])
def test_it_leaves_no_doubt_where_another_place_fits(unlikely, left):
    ruling = stand(four_places(unlikely), 1, 6.0)
    assert ruling.why.startswith(f"88% alike; {left} places") == bool(left)


def test_what_a_mission_finds_out_of_look_alikes_the_next_one_knows():
    known = LookAlikes()
    places = places_of(FIRST | SECOND | THIRD, known=known)
    for node, differs in ((9, 30.0), (17, 40.0), (1, 6.0)):
        ruling = stand(places, node, differs)
    assert ruling.why == ""
    assert len(known.told) == 2
    assert known.equal == 0


def test_equal_places_are_learned_where_a_mission_ends_in_doubt():
    known = LookAlikes()
    places = places_of(FIRST | SECOND, known=known)
    for node in (1, 9, 1):
        ruling = stand(places, node, 6.0)
    assert ruling.failure == "ambiguous"
    assert (known.told, known.equal) == ([], 1)
