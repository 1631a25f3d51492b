"""What a map costs is measured with the code that the service runs."""

import numpy as np
import pytest

from experiments.scale.frames import Seen
from experiments.scale.measure import exhaustive, load, localise, track
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose

PLACES, WORDS = 140, 300


@pytest.fixture(scope="module")
def pipeline() -> Pipeline:
    return Pipeline(find_profile("sift"))


def place(number: int) -> FeatureSet:
    rng = np.random.default_rng(number)
    lonlat = np.stack([rng.uniform(-np.pi, np.pi, WORDS), rng.uniform(-1, 1, WORDS)], axis=1)
    descriptors = rng.integers(0, 120, (WORDS, 128)).astype(np.uint8)
    return FeatureSet(lonlat.astype(np.float32), np.ones(WORDS, np.float32), descriptors)


def test_a_picture_is_found_among_many_as_exhaustive_search_finds_it(pipeline):
    nodes = [place(number) for number in range(PLACES)]
    places, load_s = load(nodes, pipeline)
    query = Seen("none", 1.0, Pose(x_m=0.0, y_m=0.0, yaw_rad=0.0), nodes[77])
    (found,) = localise([query], places, pipeline)
    assert load_s > 0.0
    assert found.node_id == 77
    inliers, _ = exhaustive(query, nodes, pipeline)
    assert inliers.argmax() == 77
    (followed,) = track([query], [[76, 77, 78]], places, pipeline)
    assert (followed.node_id, followed.inliers) == (77, found.inliers)
