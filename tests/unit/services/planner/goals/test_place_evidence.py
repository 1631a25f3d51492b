"""Which of several places it is: by matches, and by what differs as pictures."""

import numpy as np

from services.planner.goals.place_evidence import PlaceEvidence, Visit
from shared.mapgraph.local.hypotheses import Hypothesis
from shared.messages.matching import DIFFERENCES_SHAPE

HERE, THERE = (Hypothesis((node,), 150, 400) for node in (1, 9))
EQUAL = Visit(200, 0.88)


def look(differs, columns=slice(None)):
    """What differs: so much in these columns, hardly anything elsewhere."""
    cells = np.full(DIFFERENCES_SHAPE, 2.0, np.float32)
    cells[6:10, columns] = differs
    return cells


def evidence(first, second, **differs):
    seen = PlaceEvidence()
    for place, visit in ((HERE, first), (THERE, second)):
        seen.visited(place, visit)
    for place, name in ((HERE, "here"), (THERE, "there")):
        for difference in differs.get(name, ()):
            seen.looked(place, look(difference))
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
    assert evidence(EQUAL, EQUAL, here=[25.0], there=[9.0]).told() == "; differences: 9: 9, 1: 25"


def test_what_differs_at_both_places_tells_nothing():
    """A robot stands in the goal picture; the rug is another one at the second place."""
    robot, a_cell_aside, rug = slice(10, 14), slice(11, 15), slice(40, 44)
    seen = evidence(EQUAL, EQUAL)
    seen.looked(HERE, look(30.0, robot))
    seen.looked(THERE, np.maximum(look(30.0, a_cell_aside), look(20.0, rug)))
    assert (seen.best(), seen.rivals()) == (HERE, [])
    assert seen.told() == "; differences: 1: 2, 9: 20"


def test_what_was_moved_since_at_both_places_leaves_a_rival():
    seen = evidence(EQUAL, EQUAL)
    seen.looked(HERE, look(25.0, slice(10, 14)))
    seen.looked(THERE, look(25.0, slice(40, 44)))
    assert seen.rivals() == [THERE]
