"""Each picture's patches are looked for in the other, however far they moved within reach."""

import numpy as np
import pytest

from services.features.changes.search import unexplained

ROWS = slice(20, 60)
SHIFT = (2, 5)
"""Down and to the right, from the reference to the current picture."""


@pytest.fixture
def reference():
    return np.random.default_rng(2).random((80, 120, 8), dtype=np.float32)


@pytest.fixture
def current(reference):
    return np.roll(reference, SHIFT, axis=(0, 1))


def test_what_moved_within_reach_is_found_both_ways_also_across_the_seam(reference, current):
    for share in unexplained(reference, current, ROWS, 6):
        assert share.shape == (40, 120)
        assert share.max() < 1e-3


def test_what_moved_further_is_not(reference, current):
    for share in unexplained(reference, current, ROWS, 3):
        assert share.min() > 0.05


@pytest.mark.parametrize("number", [0, 1])
def test_what_only_one_picture_has_is_told_where_that_picture_has_it(reference, current, number):
    strange = (reference, current)[number]
    strange[32:44, 70:82] = np.random.default_rng(3).random((12, 12, 8), dtype=np.float32)
    share = unexplained(reference, current, ROWS, 6)[number]
    row, column = np.unravel_index(np.argmax(share), share.shape)
    assert abs(row + ROWS.start - 37.5) <= 4
    assert abs(column - 75.5) <= 4
    assert share.max() > 0.1


def test_nothing_is_like_nothing(reference):
    blank = np.zeros_like(reference)
    assert max(share.max() for share in unexplained(blank, blank, ROWS, 3)) == 0.0
    assert min(share.min() for share in unexplained(blank, reference, ROWS, 3)) > 0.9
