"""Views in a row, each from further on, that show other places refute where a robot believes to be."""

import pytest

from services.planner.travel.doubts import DOUBTS, LOOK_AROUND_M, Doubts


def refuted(doubts, views, way_m=LOOK_AROUND_M):
    """Whether each of so many views, that far apart, is one too many."""
    found = []
    for _ in range(views):
        doubts.went(way_m)
        found.append(doubts.refute())
    return found


def test_so_many_views_in_a_row_refute_a_belief():
    assert refuted(Doubts(), DOUBTS) == [False] * (DOUBTS - 1) + [True]


def test_views_from_beside_one_another_are_one():
    assert not any(refuted(Doubts(), 10, way_m=0.1))


def test_a_view_that_agrees_takes_away_all_doubts():
    doubts = Doubts()
    refuted(doubts, DOUBTS - 1)
    doubts.settle()
    assert refuted(doubts, DOUBTS) == [False] * (DOUBTS - 1) + [True]


@pytest.mark.parametrize(("way_m", "due"), [(0.9 * LOOK_AROUND_M, False), (LOOK_AROUND_M, True)])
def test_a_view_of_the_whole_map_is_due_after_some_way(way_m, due):
    doubts = Doubts()
    doubts.went(way_m)
    assert doubts.are_due == due
    doubts.settle()
    assert not doubts.are_due
