"""Nodes come, change and go; a large map is searched by what the whole panorama looks like."""

import numpy as np
import pytest

from services.features.map_features.map_features import MapFeatures
from services.features.pipeline.interfaces import FeatureSet
from services.features.retrieval.index import LEARN_FROM
from shared.messages.features import Features

KEYPOINTS, WIDTH = 40, 16


def look(number: int, noise: float = 0.0, shuffled: bool = False) -> Features:
    """Features that only this node has; seen again they differ by `noise`, and come in another order."""
    rng, seen = np.random.default_rng(number), np.random.default_rng(99)
    numbers = rng.integers(0, 256, (KEYPOINTS, WIDTH)) + seen.normal(
        scale=max(noise, 1e-9), size=(KEYPOINTS, WIDTH)
    )
    order = seen.permutation(KEYPOINTS) if shuffled else np.arange(KEYPOINTS)
    return Features(
        pipeline="sift",
        lonlat_rad=np.zeros((KEYPOINTS, 2), np.float32),
        scores=np.ones(KEYPOINTS, np.float32),
        descriptors=np.clip(numbers[order], 0, 255).astype(np.uint8),
    )


def query(number: int) -> FeatureSet:
    features = look(number, noise=20.0, shuffled=True)
    return FeatureSet(features.lonlat_rad, features.scores, features.descriptors)


def nodes(count: int) -> MapFeatures:
    kept = MapFeatures("sift", KEYPOINTS, "euclidean")
    for number in range(count):
        kept.put(1000 + number, look(number))
    return kept


def test_a_small_map_is_compared_as_a_whole():
    kept = nodes(LEARN_FROM - 1)
    assert kept.nearest(query(3), 5) == kept.ids == list(range(1000, 1000 + LEARN_FROM - 1))


@pytest.mark.parametrize("count", [LEARN_FROM, 2 * LEARN_FROM + 10])
def test_in_a_large_map_the_right_node_comes_first_however_the_camera_is_turned(count):
    kept = nodes(count)
    found = [kept.nearest(query(number), 5) for number in range(0, count, 7)]
    assert all(len(ids) == 5 for ids in found)
    assert [ids[0] for ids in found] == [1000 + number for number in range(0, count, 7)]


def test_nodes_that_come_after_learning_are_found_and_those_that_went_are_not():
    kept = nodes(LEARN_FROM + 10)
    kept.prepare()
    kept.put(5, look(70_000))
    kept.remove(1003)
    assert kept.nearest(query(70_000), 3)[0] == 5
    assert 1003 not in kept.nearest(query(3), len(kept) - 1)
    assert 1003 not in kept
    with pytest.raises(KeyError):
        kept.features(1003)


def test_a_node_that_changed_is_found_by_its_new_look_only():
    kept = nodes(LEARN_FROM)
    kept.prepare()
    kept.put(1004, look(70_001))
    assert kept.nearest(query(70_001), 1) == [1004]
    assert kept.nearest(query(4), 1) != [1004]
    assert np.abs(kept.features(1004).descriptors - look(70_001).descriptors).max() < 10


def test_the_same_nodes_are_ranked_the_same_in_every_process():
    first, second = nodes(300), nodes(300)
    assert [first.nearest(query(n), 20) for n in range(30)] == [
        second.nearest(query(n), 20) for n in range(30)
    ]


def test_nodes_of_another_pipeline_are_known_but_not_compared():
    kept = nodes(3)
    kept.put(1001, look(1).model_copy(update={"pipeline": "orb"}))
    assert kept.of_other_pipelines == {1001: "orb"}
    assert kept.ids == [1000, 1002]
    assert len(kept) == 3
    assert 1001 in kept
    kept.put(1001, look(1))
    assert kept.of_other_pipelines == {}


def test_a_node_of_a_wrong_kind_is_refused_and_the_others_stay():
    kept = nodes(2)
    wrong = look(9).model_copy(update={"descriptors": np.zeros((KEYPOINTS, WIDTH + 1), np.uint8)})
    with pytest.raises(ValueError, match="expected"):
        kept.put(7, wrong)
    kept.put(8, look(8))
    assert kept.ids == [8, 1000, 1001]
    assert np.abs(kept.features(1001).descriptors - look(1).descriptors).max() < 10
