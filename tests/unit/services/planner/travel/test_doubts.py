"""Views of other places from here and there refute where a robot believes to be."""

import itertools

import pytest

from services.planner.travel.doubts import DOUBTS, LOOK_AROUND_M, Doubts
from shared.motion.motion import Motion

ON, BACK = Motion(LOOK_AROUND_M, 0.0), Motion(-LOOK_AROUND_M, 0.0)


def refuted(doubts, ways):
    """Whether the belief is refuted by a view of another place after each of these ways."""
    found = []
    for moved in ways:
        doubts.went(moved)
        found.append(doubts.refute())
    return found


def test_so_many_spots_refute_a_belief():
    assert refuted(Doubts(), [ON] * DOUBTS) == [False] * (DOUBTS - 1) + [True]


def test_views_from_beside_one_another_are_one():
    assert not any(refuted(Doubts(), [Motion(0.1, 0.0)] * 10))


def test_to_and_fro_there_are_but_two_spots():
    assert not any(refuted(Doubts(), itertools.islice(itertools.cycle([ON, BACK]), 20)))


def test_a_view_that_agrees_takes_away_all_doubts():
    doubts = Doubts()
    refuted(doubts, [ON] * (DOUBTS - 1))
    doubts.settle()
    assert refuted(doubts, [ON] * DOUBTS) == [False] * (DOUBTS - 1) + [True]


@pytest.mark.parametrize(("share", "due"), [(0.9, False), (1.0, True)])
def test_a_view_of_the_whole_map_is_due_after_some_way(share, due):
    doubts = Doubts()
    doubts.went(Motion(share * LOOK_AROUND_M, 0.0))
    assert doubts.are_due == due
    doubts.settle()
    assert not doubts.are_due
