"""Which of several places it is: by matches, and by what differs as pictures."""

from services.planner.goals.place_evidence import PlaceEvidence, Visit
from shared.mapgraph.local.hypotheses import Hypothesis

HERE, THERE = (Hypothesis((node,), 150, 400) for node in (1, 9))
EQUAL = Visit(200, 0.88)


def evidence(first, second, **differs):
    seen = PlaceEvidence()
    for place, visit in ((HERE, first), (THERE, second)):
        seen.visited(place, visit)
    for place, name in ((HERE, "here"), (THERE, "there")):
        for difference in differs.get(name, ()):
            seen.looked(place, difference)
    return seen


def test_a_place_with_fewer_matches_is_excluded():
    seen = evidence(EQUAL, Visit(130, 0.6))
    assert (seen.best(), seen.rivals()) == (HERE, [])


def test_equal_matches_leave_a_rival():
    seen = evidence(EQUAL, Visit(190, 0.86))
    assert (seen.best(), seen.rivals()) == (HERE, [THERE])


def test_a_place_that_differs_by_more_than_chance_is_excluded_though_it_has_more_matches():
    seen = evidence(Visit(180, 0.8), EQUAL, here=[25.0, 9.0, 14.0], there=[40.0, 28.0])
    assert (seen.best(), seen.rivals()) == (HERE, [])


def test_equal_rooms_differ_by_chance_and_stay_rivals():
    seen = evidence(EQUAL, Visit(195, 0.86), here=[9.0], there=[22.0])
    assert seen.rivals() == [THERE]


def test_matches_and_difference_that_contradict_each_other_leave_a_rival():
    seen = evidence(EQUAL, Visit(120, 0.6), here=[15.0], there=[9.0])
    assert (seen.best(), seen.rivals()) == (HERE, [THERE])


def test_a_place_visited_in_vain_where_nothing_was_compared_is_no_rival():
    seen = evidence(EQUAL, Visit(), here=[9.0])
    assert (seen.best(), seen.rivals()) == (HERE, [])


def test_nobody_has_been_anywhere():
    seen = PlaceEvidence()
    assert (seen.best(), seen.rivals(), seen.told()) == (None, [], "")


def test_what_differs_is_told_the_least_first():
    assert evidence(EQUAL, EQUAL, here=[25.0], there=[9.0]).told() == "9: 9, 1: 25"
