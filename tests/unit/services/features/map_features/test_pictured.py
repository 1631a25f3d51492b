"""Nodes as photos are compared with them: more keypoints, out of pictures that are fine enough."""

import cv2
import numpy as np
import pytest

from services.features.map_features.pictured import LEAST_SHARE, PicturedNodes
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline

PIPELINE = Pipeline(find_profile("sift"))
KEPT = PIPELINE.profile.keypoints


@pytest.fixture
def nodes():
    return PicturedNodes(PIPELINE)


def picture(room, columns, x_m=0.0):
    return cv2.imencode(".jpg", room(x_m, 0.0, 0.0, columns // 2))[1].tobytes()


def test_a_node_has_more_keypoints_than_frames_are_compared_by(nodes, room):
    nodes.put(3, picture(room, 800))
    assert nodes.missing([2, 3]) == [2]
    found = nodes.nodes.features(3)
    assert len(found) > 1.5 * KEPT
    strongest = PIPELINE.features_of_picture(room(0.0, 0.0, 0.0, 400), KEPT).lonlat_rad
    apart = np.abs(found.lonlat_rad[:, None] - strongest[None]).max(axis=2).min(axis=0)
    assert np.mean(apart < 0.01) > 0.8, "those that frames are compared by are among them"


@pytest.mark.parametrize("columns", [0, 320, int(LEAST_SHARE * 800) - 4])
def test_a_node_whose_picture_is_too_small_or_missing_is_left_at_what_it_has(nodes, room, columns):
    nodes.put(3, picture(room, columns) if columns else b"")
    assert nodes.missing([3]) == []
    assert 3 not in nodes.nodes


@pytest.mark.parametrize("jpeg", [b"no picture", b"\xff\xd8\xff\xc0\x00\x11\x08\xff\xff\xff\xff\x03"])
def test_what_is_no_picture_is_as_none(nodes, jpeg):
    nodes.put(3, jpeg)
    assert nodes.missing([3]) == []
    assert len(nodes.nodes) == 0


def test_a_node_that_changed_is_looked_at_again(nodes, room):
    nodes.put(3, picture(room, 800))
    nodes.put(4, b"")
    for node_id in (3, 4, 5):
        nodes.remove(node_id)
    assert nodes.missing([3, 4, 5]) == [3, 4, 5]
    nodes.put(4, picture(room, 800, 1.0))
    assert 4 in nodes.nodes
