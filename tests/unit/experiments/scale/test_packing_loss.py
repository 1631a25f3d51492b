"""What is lost by packing is measured on places as the service keeps them."""

import numpy as np
import pytest

from experiments.scale.packing_loss import loss
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline

WORDS = 200


@pytest.fixture(scope="module")
def pipeline() -> Pipeline:
    return Pipeline(find_profile("sift"))


def pictures(spread: int) -> tuple[FeatureSet, FeatureSet]:
    """The same keypoints seen from two nodes; descriptors differ by a tenth of their `spread`."""
    rng = np.random.default_rng(3)
    points_m = rng.uniform(-5.0, 5.0, (WORDS, 3))
    kinds = rng.integers(60, 60 + spread, (WORDS, 128))
    seen = []
    for step_m in (0.0, 0.4):
        x, y, z = (points_m - (step_m, 0.0, 0.0)).T
        lonlat = np.stack([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y))], axis=1)
        noise = rng.normal(scale=0.1 * spread, size=kinds.shape)
        descriptors = np.clip(np.rint(kinds + noise), 0, 255).astype(np.uint8)
        seen.append(FeatureSet(lonlat.astype(np.float32), np.ones(WORDS, np.float32), descriptors))
    return seen[1], seen[0]


def test_features_like_real_ones_lose_next_to_nothing(pipeline):
    row = loss(pipeline, [pictures(120)])
    assert row["matches"] > 0.9 * WORDS
    assert abs(row["lost"]) < 0.02
    assert (row["descriptor_bytes"], row["bytes_per_word"]) == (128, 73.0)


def test_a_packing_that_keeps_too_little_shows(pipeline, monkeypatch):
    monkeypatch.setattr("services.features.map_features.packing.LEVELS", 1)
    assert loss(pipeline, [pictures(120)])["lost"] > 0.02
