"""Candidates judge one another round the shortest cycles through both maps."""

import math

import numpy as np
import pytest

from shared.mapgraph.merging.candidates import Candidate, candidates_of
from shared.mapgraph.merging.votes import cycle_closes, supported, votes_among
from shared.mapgraph.triangle import Sight
from tests.merge_world import Streets, match, row


def test_of_three_the_one_the_others_contradict_is_dropped_and_so_is_one_alone():
    rng = np.random.default_rng(0)
    here, there = row(rng, 0.0, 0.0, 2)
    one, two, odd, alone = (Candidate(n, n, match(n, here, there, rng), near=True) for n in range(4))
    votes = {
        one: {two: 9, odd: -9},
        two: {one: 9, odd: -9},
        odd: {one: -9, two: -9},
        alone: {},
    }
    assert supported(votes, votes) == {one, two}


def test_two_nodes_that_see_the_same_one_support_each_other():
    world = Streets(0)
    sure = candidates_of(world.base_map, world.other_map, world.true_matches())
    votes = votes_among(world.base_map, world.other_map, sure)
    same = [vote > 0 for one in sure for two, vote in votes[one].items() if one.base == two.base]
    assert len(same) > 10
    assert sum(same) > 0.9 * len(same)


SQUARE = [Sight(0.0, math.pi / 2)] * 4
"""Each side ahead, then a quarter turn to the left."""


@pytest.mark.parametrize(
    ("legs", "closes"),
    [
        pytest.param(SQUARE, True, id="a square"),
        pytest.param([*SQUARE[:3], Sight(0.0, 1.2)], False, id="yaws that do not add up"),
        pytest.param([Sight(0.0, 0.0)] * 4, False, id="all ahead"),
        pytest.param([Sight(h, 0.0) for h in (0.0, 1.0, 1.5, 2.6)], False, id="all into one half"),
        pytest.param([Sight(0.0, 0.0), Sight(math.pi, 0.0)], True, id="there and back"),
        pytest.param([Sight(0.0, 0.0), Sight(2.0, 0.0)], False, id="there and elsewhere"),
        pytest.param([Sight(None, 0.5), Sight(None, -0.5)], True, id="nobody moved"),
        pytest.param([Sight(None, 0.5), Sight(1.0, -0.5)], False, id="one moved"),
        pytest.param([*SQUARE[:3], Sight(0.0, None)], False, id="a yaw nobody knows"),
    ],
)
def test_a_cycle_closes_when_yaws_add_up_and_bearings_lead_back(legs, closes):
    assert cycle_closes(legs) is closes
