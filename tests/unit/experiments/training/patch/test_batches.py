"""Batches hold no two patches of one spot, of as many panoramas as asked."""

from dataclasses import replace

import numpy as np

from experiments.training.patch.batches import draw_batch, near
from tests.unit.experiments.training.patch.painted import noise

ALL = noise(240, panoramas=12, worlds=3)


def draw(patches, count=40, panoramas=6, seed=1):
    return draw_batch(patches, count, panoramas, np.random.default_rng(seed))


def test_a_batch_is_of_as_many_panoramas_as_asked_and_of_no_row_twice():
    rows = draw(ALL)
    assert len(rows) == len(set(rows.tolist())) == 40
    assert len(np.unique(ALL.panoramas[rows])) == 6
    assert np.array_equal(rows, draw(ALL))
    assert not np.array_equal(rows, draw(ALL, seed=2))


def test_a_point_seen_from_two_pairs_of_panoramas_comes_once():
    points = np.repeat(ALL.points_m[:20], 12, axis=0)
    assert len(draw(replace(ALL, points_m=points, worlds=np.zeros(240, np.int32)), 40, 12)) <= 20


def test_what_overlaps_in_one_picture_comes_once_though_it_lies_behind_one_another():
    ahead = ALL.bearings.copy()
    ahead[:, 1] = (1.0, 0.0, 0.0)
    rows = draw(replace(ALL, bearings=ahead))
    assert len(rows) == len(np.unique(ALL.panoramas[rows])) == 6


def test_the_same_coordinates_in_another_world_are_another_spot():
    two = replace(ALL[:2], points_m=np.zeros((2, 3), np.float32))
    assert near(two).all()
    assert not near(replace(two, worlds=np.arange(2, dtype=np.int32)))[0, 1]


def test_near_grows_with_the_range():
    apart = np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]], np.float32)
    for range_m, same in ((2.0, False), (8.0, True)):
        two = replace(ALL[:2], points_m=apart, ranges_m=np.full(2, range_m, np.float32))
        assert near(two)[0, 1] == same
