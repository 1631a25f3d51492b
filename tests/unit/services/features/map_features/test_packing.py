"""Half the room, and as good as the same features."""

import numpy as np
import pytest

from services.features.map_features.packing import Packing
from services.features.pipeline.interfaces import FeatureSet


def features(descriptors: np.ndarray) -> FeatureSet:
    rng = np.random.default_rng(4)
    count = len(descriptors)
    lonlat = np.stack([rng.uniform(-np.pi, np.pi, count), rng.uniform(-1.2, 1.2, count)], axis=1)
    return FeatureSet(lonlat.astype(np.float32), rng.random(count, dtype=np.float32), descriptors)


@pytest.mark.parametrize("width", [1, 7, 128])
@pytest.mark.parametrize("dtype", ["uint8", "float16", "float32"])
def test_numbers_come_back_within_half_a_step_of_their_own_range(width, dtype):
    rng = np.random.default_rng(width)
    numbers = rng.integers(0, 256, (40, width)) if dtype == "uint8" else rng.normal(size=(40, width))
    before = features(numbers.astype(dtype))
    packing = Packing(50, width, dtype, "euclidean")
    after = packing.unpack(packing.pack(before))
    spread = np.ptp(before.descriptors.astype(np.float32), axis=1, keepdims=True)
    step = np.ceil(spread / 15) if dtype == "uint8" else spread / 15
    assert (np.abs(after.descriptors - before.descriptors.astype(np.float32)) <= 0.52 * step + 2e-3).all()
    assert after.descriptors.dtype == np.float32
    assert np.abs(after.scores - before.scores).max() < 1e-3


def test_bits_come_back_unchanged():
    before = features(np.random.default_rng(1).integers(0, 256, (20, 32)).astype(np.uint8))
    packing = Packing(20, 32, "uint8", "hamming")
    assert (packing.unpack(packing.pack(before)).descriptors == before.descriptors).all()


def test_directions_come_back_to_a_hundredth_of_a_degree_even_at_the_seam():
    before = features(np.zeros((4, 2), np.uint8))
    before.lonlat_rad[:, 0] = [np.pi, -np.pi, np.nextafter(np.float32(np.pi), 0), 0.0]
    packing = Packing(4, 2, "uint8", "euclidean")
    after = packing.unpack(packing.pack(before))
    apart = np.remainder(after.lonlat_rad - before.lonlat_rad + np.pi, 2 * np.pi) - np.pi
    assert np.rad2deg(np.abs(apart)).max() < 0.01


def test_three_hundred_root_sift_descriptors_take_less_than_22_kilobytes():
    assert Packing(300, 128, "uint8", "euclidean").record.itemsize < 22_000


@pytest.mark.parametrize(
    "other", [np.zeros((6, 8), np.uint8), np.zeros((3, 9), np.uint8), np.zeros((3, 8), np.float32)]
)
def test_features_that_do_not_fit_are_refused_naming_both_kinds(other):
    with pytest.raises(ValueError, match=r"at most 5 descriptors of 8 x uint8 expected, got \d of \d x "):
        Packing(5, 8, "uint8", "euclidean").pack(features(other))


def test_a_node_without_features_stays_empty():
    packing = Packing(5, 8, "uint8", "euclidean")
    assert len(packing.unpack(packing.pack(features(np.zeros((0, 8), np.uint8))))) == 0
