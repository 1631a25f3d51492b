"""Cached maps follow deltas exactly, and are forgotten as soon as they might be wrong."""

import numpy as np
import pytest

from services.features.map_features.map_cache import MapCache
from services.features.map_features.map_features import MapFeatures
from shared.messages.features import Features
from shared.messages.maps import AddNode, DeleteNode, MapDelta, Node, NodeFeatures


def features(pipeline: str = "sift") -> Features:
    return Features(
        pipeline=pipeline,
        lonlat_rad=np.zeros((1, 2), np.float32),
        scores=np.zeros(1, np.float32),
        descriptors=np.zeros((1, 4), np.uint8),
    )


def add(node_id: int) -> AddNode:
    return AddNode(node=Node(node_id=node_id), features=features())


@pytest.fixture
def cache() -> MapCache:
    kept = MapCache(lambda: MapFeatures("sift", 1, "euclidean"))
    kept.load("flat", 3, [NodeFeatures(node_id=1, features=features())])
    return kept


def test_a_map_never_read_stays_unknown(cache):
    cache.apply(MapDelta(map="cellar", revision=1, operations=(add(1),)))
    assert cache.get("cellar") is None


def test_nodes_come_and_go_with_deltas_in_order(cache):
    cache.apply(MapDelta(map="flat", revision=4, operations=(add(2), add(3))))
    cache.apply(
        MapDelta(map="flat", revision=5, operations=(DeleteNode(node_id=1), add(4), DeleteNode(node_id=4)))
    )
    assert cache.get("flat").nodes.ids == [2, 3]
    assert cache.get("flat").revision == 5


@pytest.mark.parametrize("revision", [1, 3])
def test_a_delta_already_in_the_map_changes_nothing(cache, revision):
    cache.apply(MapDelta(map="flat", revision=revision, operations=(DeleteNode(node_id=1),)))
    assert cache.get("flat").nodes.ids == [1]


def test_a_gap_forgets_the_map(cache):
    cache.apply(MapDelta(map="flat", revision=5, operations=(add(2),)))
    assert cache.get("flat") is None


@pytest.mark.parametrize("revision", [0, 3, 9])
def test_a_reset_forgets_the_map_whatever_its_revision(cache, revision):
    cache.apply(MapDelta(map="flat", revision=revision, reset=True))
    assert cache.get("flat") is None


def test_a_place_that_changes_or_goes_loses_what_was_seen_on_its_picture(cache):
    seen = []

    class Pictured:
        def remove(self, node_id):
            seen.append(node_id)

    cache.get("flat").pictured = Pictured()
    cache.apply(MapDelta(map="flat", revision=4, operations=(add(2), DeleteNode(node_id=1))))
    assert seen == [2, 1]
