"""What recurs and what is answered, of keypoints whose true places are known."""

import numpy as np
import pytest

from experiments.rendered.pairs import PosePair
from experiments.training.correspondences import correspondences
from experiments.training.keypoints.measure import answer, answers, profile_of, recurrence
from experiments.training.sights import CameraPose, projected
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from shared.messages.simulation import Pose
from tests.unit.experiments.training.boxes import in_a_box

COUNT, WRONG = 80, 10
HERE, THERE = CameraPose(1.0, 0.5, 0.3, 0.1), CameraPose(-1.0, -0.2, -2.0, 0.1)
PAIR = PosePair(Pose(x_m=1.0, y_m=0.5, yaw_rad=0.3), Pose(x_m=-1.0, y_m=-0.2, yaw_rad=-2.0))


@pytest.fixture(scope="module")
def seen():
    """Two sights and their keypoints: of the second, `WRONG` look like others and are elsewhere."""
    rng = np.random.default_rng(4)
    here, there = in_a_box(HERE), in_a_box(THERE)
    first = np.stack([rng.uniform(-np.pi, np.pi, COUNT), rng.uniform(-0.6, 0.6, COUNT)], axis=-1)
    second, _ = projected(first, here, there)
    second[:WRONG, 0] += 0.5
    look = rng.standard_normal((COUNT, 128)).astype(np.float32)
    look /= np.linalg.norm(look, axis=1, keepdims=True)
    features = [
        FeatureSet(at.astype(np.float32), np.ones(COUNT, np.float32), look, np.full(COUNT, 0.05, np.float32))
        for at in (first, second)
    ]
    return here, there, features


def test_what_moved_away_does_not_recur_and_chance_is_counted_apart(seen):
    here, there, (first, second) = seen
    row = recurrence(first, second, here, there)
    assert row["keypoints"] == row["visible"] == COUNT
    assert COUNT - WRONG <= row["recurring"] <= COUNT - WRONG + 2
    assert row["by_chance"] < COUNT // 8
    assert recurrence(first, second, here, in_a_box(THERE, hidden=True))["visible"] == 0


def test_the_matcher_takes_what_looks_alike_and_the_oracle_what_is_true(seen):
    here, there, (first, second) = seen
    row = answers(first, second, here, there, PAIR, Pipeline(find_profile("sift")))
    assert row["matcher"]["matches"] == COUNT
    assert COUNT - WRONG <= row["matcher"]["right"] <= COUNT - WRONG + 2
    assert row["oracle"]["matches"] == row["oracle"]["right"] == row["oracle"]["possible"]
    for one in row.values():
        assert one["answered"]
        assert one["verified_right"] > 0.9 * (COUNT - WRONG)
        assert one["heading_off_deg"] < 2.0


def test_what_is_verified_but_not_true_is_not_right(seen):
    here, _, (first, second) = seen
    pipeline = Pipeline(find_profile("sift"))
    (matched,) = pipeline.matcher.match(first, [second])
    nothing = correspondences(first.lonlat_rad, second.lonlat_rad, here, in_a_box(THERE, hidden=True))
    row = answer(first, second, matched, nothing, PAIR, pipeline)
    assert row["verified"] > 0.9 * (COUNT - WRONG)
    assert row["right"] == row["verified_right"] == row["possible"] == 0


def test_an_unknown_detector_is_named_with_those_there_are():
    assert profile_of("keynet").detector == "keynet"
    with pytest.raises(ValueError, match=r"keynet or an extractor of .*'sift'.*, got 'soft'"):
        profile_of("soft")
