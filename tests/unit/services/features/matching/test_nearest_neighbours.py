"""Nearest neighbours: equal to the plain definition for bytes, bits and floats, ragged and empty frames."""

import numpy as np
import pytest

from services.features.matchers.brute_force import BruteForce
from services.features.matchers.mutual_ratio import MutualRatio
from services.features.matching.nearest_neighbours import find_neighbours
from services.features.pipeline.interfaces import FeatureSet, Profile


def features(descriptors: np.ndarray) -> FeatureSet:
    count = len(descriptors)
    return FeatureSet(np.zeros((count, 2), np.float32), np.zeros(count, np.float32), descriptors)


def by_definition(query: np.ndarray, other: np.ndarray, distance: str) -> np.ndarray:
    """(Q, N) squared Euclidean distances, or four times the Hamming distances."""
    if distance == "hamming":
        bits = np.unpackbits(query[:, None, :] ^ other[None, :, :], axis=2)
        return 4.0 * bits.sum(axis=2)
    difference = query[:, None, :].astype(np.float64) - other[None, :, :].astype(np.float64)
    return (difference**2).sum(axis=2)


@pytest.mark.parametrize("distance", ["euclidean", "hamming"])
def test_neighbours_equal_the_definition_in_frames_of_any_size(distance):
    rng = np.random.default_rng(0)
    query = rng.integers(0, 256, (40, 32), dtype=np.uint8)
    others = [rng.integers(0, 256, (count, 32), dtype=np.uint8) for count in (30, 1, 7, 50, 2, 41)]
    for other, found in zip(others, find_neighbours(query, others, distance), strict=True):
        table = by_definition(query, other, distance)
        ordered = np.sort(table, axis=1)
        np.testing.assert_array_equal(found.nearest, table.argmin(axis=1))
        np.testing.assert_array_equal(found.first, ordered[:, 0])
        np.testing.assert_array_equal(found.second, ordered[:, 1] if len(other) > 1 else np.inf)
        closest = table.min(axis=0)[found.nearest]
        assert (found.first[found.mutual] == closest[found.mutual]).all()
        for row in np.flatnonzero(found.mutual):
            rest = np.delete(table[:, found.nearest[row]], row)
            assert found.rival[row] == rest.min()
        assert (found.rival[~found.mutual] == closest[~found.mutual]).all()
        assert sorted(found.nearest[found.mutual]) == sorted(set(found.nearest[found.first == closest]))


def test_float_descriptors_are_compared_as_they_are():
    query = np.array([[0.0, 1.0]], np.float32)
    other = np.array([[0.0, 0.5], [1.0, 1.0]], np.float16)
    (found,) = find_neighbours(query, [other], "euclidean")
    assert (found.nearest[0], found.first[0], found.second[0]) == (0, 0.25, 1.0)


@pytest.mark.parametrize("distance", ["euclidean", "hamming"])
def test_a_match_is_the_likelier_right_the_less_others_are_alike_on_either_side(distance):
    first, again = np.array([[0]], np.uint8), np.array([[0], [0b1111_1100]], np.uint8)
    other = np.array([[0b0000_1111], [0b0011_1111]], np.uint8)
    (alone,), (rivalled,) = (find_neighbours(query, [other], distance) for query in (first, again))
    assert alone.right(distance)[0] > rivalled.right(distance)[0]


def test_the_ratio_is_one_of_distances_not_of_squares():
    query, other = np.array([[0]], np.uint8), np.array([[8], [10]], np.uint8)
    for ratio, count in ((0.79, 0), (0.81, 1)):
        (matched,) = MutualRatio(Profile("sift", ratio=ratio), "euclidean").match(
            features(query), [features(other)]
        )
        assert len(matched) == count


def test_the_hamming_ratio_is_one_of_bits():
    query, other = np.array([[0]], np.uint8), np.array([[0b1111], [0b11111]], np.uint8)
    for ratio, count in ((0.79, 0), (0.81, 1)):
        (matched,) = MutualRatio(Profile("orb", ratio=ratio), "hamming").match(
            features(query), [features(other)]
        )
        assert len(matched) == count


def test_equal_descriptors_never_share_a_partner():
    query = np.full((3, 8), 7, np.uint8)
    other = np.array([[7] * 8, [200] * 8], np.uint8)
    (matched,) = MutualRatio(Profile("sift"), "euclidean").match(features(query), [features(other)])
    assert matched.pairs.tolist() == [[0, 0]]
    (matched,) = BruteForce(Profile("sift"), "euclidean").match(features(query), [features(other)])
    assert matched.pairs.tolist() == [[0, 0]]


@pytest.mark.parametrize("matcher", [MutualRatio, BruteForce])
def test_empty_frames_match_nothing(matcher):
    none, some = features(np.zeros((0, 128), np.uint8)), features(np.eye(128, dtype=np.uint8))
    plugin = matcher(Profile("sift"), "euclidean")
    assert [len(pairs) for pairs in plugin.match(some, [none, some, none])] == [0, 128, 0]
    assert [len(pairs) for pairs in plugin.match(none, [none, some])] == [0, 0]
    assert plugin.match(some, []) == []
