"""What a pair of pictures teaches: its partners, what is near them, and nothing where there are too few."""

import cv2
import numpy as np
import pytest

from experiments.training.data.shards import Pair, Shard, write_shard
from experiments.training.residual.samples import FEWEST, sample_of, samples_of
from experiments.training.sights import CameraPose, Sight
from experiments.training.worlds import first_worlds
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline

POSE = CameraPose(0.0, 0.0, 0.4, 0.8)


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline(find_profile("sift"))


def twice(picture) -> Pair:
    """The same place twice: each keypoint is its own partner."""
    sight = Sight(picture, np.full(picture.shape[:2], 3.0), POSE)
    return Pair(sight, sight, (1.0, 1.0))


def blobs():
    noise = np.random.default_rng(1).integers(0, 256, (256, 512), np.uint8)
    smooth = cv2.normalize(cv2.GaussianBlur(noise, (0, 0), 3.0), None, 0, 255, cv2.NORM_MINMAX)
    return cv2.cvtColor(smooth, cv2.COLOR_GRAY2BGR)


def test_the_same_place_twice_has_every_keypoint_as_its_own_partner(pipeline):
    sample = sample_of(twice(blobs()), pipeline)
    count = len(sample.descriptors[0])
    assert count > 100
    assert sample.descriptors[0].dtype == np.float32
    assert len(sample.partners) > 0.8 * count  # SIFT finds one corner twice, with two directions
    rows = sample.partners[:, 0]
    assert sample.near[rows, sample.partners[:, 1]].all()
    assert sample.near.mean() < 0.05


def test_the_context_is_latitude_size_and_strength(pipeline):
    context, _ = sample_of(twice(blobs()), pipeline).contexts
    assert np.abs(context[:, 0]).max() <= np.sin(np.deg2rad(66.0))
    np.testing.assert_allclose(context[:, 1], context[:, 0] ** 2, rtol=1e-5)
    assert (np.diff(context[:, 3]) <= 0.0).all()  # the strongest come first


def test_pairs_with_few_partners_are_left_out(tmp_path, pipeline):
    (world,) = first_worlds("development", 1)
    pairs = [twice(blobs()), twice(np.full((256, 512, 3), 128, np.uint8))]
    jpegs = [
        bytes(cv2.imencode(".jpg", sight.picture)[1]) for pair in pairs for sight in (pair.here, pair.there)
    ]
    path = write_shard(tmp_path, f"{world}-000", Shard(world, pairs, {"recipe": {}}), jpegs)
    (sample,) = samples_of([path], pipeline)
    assert len(sample.partners) >= FEWEST
