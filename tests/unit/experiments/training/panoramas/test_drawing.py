"""Pairs see what is asked for; where none can be had, somebody is told what to do."""

import numpy as np
import pytest

from experiments.training.panoramas.drawing import Pairs
from services.launcher.client.failure import ExperimentError
from tests.unit.experiments.training.places import HIDDEN

EVERY = {(0, 1), (1, 0), (0, 2), (2, 0), (1, 2), (2, 1), (4, 5), (5, 4)}
"""All that see one another: the third in half of the directions."""


def drawn(pairs, count=300, others=0.0, seed=1):
    return pairs.draw(count, np.random.default_rng(seed), others)


def as_set(pairs):
    return {tuple(row) for row in pairs.tolist()}


def test_pairs_are_those_that_see_one_another_and_never_one_with_itself(places):
    pairs = Pairs(places.panoramas, 0.1, 6.0)
    assert as_set(drawn(pairs)) == EVERY
    assert len(pairs) == len(EVERY)


def test_each_of_a_pair_sees_enough_of_the_other(places):
    table = places.panoramas.overlap.float().clone()
    table[0, 1] = 0.2  # the other way, nearly all
    lopsided = type(places.panoramas)(**{**vars(places.panoramas), "overlap": table.half()})
    assert as_set(drawn(Pairs(lopsided, 0.3, 6.0))) == EVERY - {(0, 1), (1, 0)}


def test_no_pair_is_farther_apart_than_asked(places):
    at = places.panoramas.positions_m
    near = {(one, other) for one, other in EVERY if (at[one] - at[other]).norm() <= 1.0}
    assert near == {(0, 1), (1, 0), (4, 5), (5, 4)}
    assert as_set(drawn(Pairs(places.panoramas, 0.1, 1.0))) == near


def test_others_are_of_any_place_and_the_rest_is_as_asked_for(places):
    pairs = Pairs(places.panoramas, 0.1, 6.0)
    found = drawn(pairs, 2000, others=1.0)
    assert (found[:, 0] != found[:, 1]).all()
    shards = places.panoramas.shard.numpy()[found]
    # Of the three tenths drawn from all, more than half are of another shard.
    assert (shards[:, 0] != shards[:, 1]).mean() == pytest.approx(0.3 * 8 / 15, abs=0.04)
    assert HIDDEN in found
    some = [tuple(row) in EVERY for row in drawn(pairs, 2000, others=0.25).tolist()]
    # Of the others 0.55 fit by chance: 2 of 3 of the seven tenths from a shard, 8 of 30 of the rest.
    assert np.mean(some) == pytest.approx(1.0 - 0.25 * 0.45, abs=0.025)


def test_the_same_generator_draws_the_same(places):
    pairs = Pairs(places.panoramas, 0.1, 6.0)
    assert np.array_equal(drawn(pairs, 40, 0.5), drawn(pairs, 40, 0.5))
    assert not np.array_equal(drawn(pairs, 40, 0.5), drawn(pairs, 40, 0.5, seed=2))


def test_where_no_two_see_one_another_it_is_said_what_to_do(places):
    with pytest.raises(ExperimentError, match=r"draw more pairs .*, or .* smaller overlap"):
        Pairs(places.panoramas, 0.1, 0.5)
