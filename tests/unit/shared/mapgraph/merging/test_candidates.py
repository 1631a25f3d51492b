"""A match between two maps as either side sees it."""

import math

import numpy as np
import pytest

from shared.mapgraph.merging.candidates import Candidate
from tests.merge_world import match, row, seen


def test_what_the_base_place_sees_of_the_other_is_the_way_back():
    rng = np.random.default_rng(0)
    here, there = row(rng, 0.0, 0.0, 2)
    back = Candidate(1, 0, match(0, here, there, rng), near=True).back
    assert (math.remainder(back.heading_rad, math.tau), back.yaw_rad) == pytest.approx(seen(there, here))
