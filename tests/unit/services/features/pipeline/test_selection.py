"""Choice of keypoints: strongest first, same answer for any input order."""

import numpy as np

from services.features.pipeline.selection import strongest


def test_the_strongest_come_first():
    assert strongest(np.zeros((4, 2)), np.array([0.2, 0.9, 0.1, 0.5], np.float32), 2).tolist() == [1, 3]


def test_fewer_than_wanted_are_all_taken():
    assert strongest(np.zeros((2, 2)), np.array([1, 2], np.float32), 10).tolist() == [1, 0]


def test_equal_scores_are_ordered_by_place_not_by_input_order():
    rng = np.random.default_rng(3)
    lonlat = rng.uniform(-1.0, 1.0, (50, 2))
    scores = np.ones(50, np.float32)
    order = rng.permutation(50)
    first, shuffled = (
        lonlat[strongest(lonlat, scores, 20)],
        lonlat[order][strongest(lonlat[order], scores, 20)],
    )
    np.testing.assert_array_equal(first, shuffled)
