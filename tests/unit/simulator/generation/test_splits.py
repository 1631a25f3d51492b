"""Splits are drawn once for all."""

from collections import Counter
from itertools import islice

from simulator.generation.kinds import KINDS, SIZES
from simulator.generation.splits import SHARES, split_of, worlds_of


def test_shares_are_those_promised():
    drawn = Counter(split_of("flat", seed) for seed in range(3000))
    for split, share in SHARES.items():
        assert abs(drawn[split] / 30.0 - share) < 3.0


def test_a_world_keeps_its_split_for_good():
    """A change here would let worlds that were judged with be built with: never change these values."""
    splits = [split_of("flat", seed) for seed in range(6)]
    assert splits == ["validation", "test", "test", "test", "development", "validation"]
    assert split_of("hostel", 2) == "validation"


def test_the_worlds_of_a_split_are_of_all_kinds_and_sizes_and_none_comes_twice():
    worlds = list(islice(worlds_of({"validation"}), 60))
    assert len(set(worlds)) == 60
    assert {split_of(kind, seed) for kind, seed, _ in worlds} == {"validation"}
    assert {kind for kind, _, _ in worlds} == set(KINDS)
    assert {size for _, _, size in worlds} == set(SIZES)
