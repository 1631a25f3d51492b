"""A question about a goal picture: beside where it was taken it is compared as a picture as well."""

import numpy as np
import pytest

from services.features.map_features.map_features import MapFeatures
from services.features.matching.requests import match_candidates, verify_candidates
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from shared.messages.matching import MatchRequest
from shared.messages.sensors import Frame
from tests.unit.services.features.matching.blobs import blobs

WIDTH_PX, HEIGHT_PX = 1024, 512


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline(find_profile("sift"))


def panorama(seed):
    return blobs(WIDTH_PX, 32, seed)


def answer(pipeline, picture, target):
    """The match of a frame with a goal picture."""
    frame, goal = (
        pipeline.features_of(
            Frame(robot="r1", encoding="bgr8", width_px=WIDTH_PX, height_px=HEIGHT_PX, data=each.tobytes())
        )
        for each in (picture, target)
    )
    request = MatchRequest(map="flat", targets=(goal,))
    raw = match_candidates(pipeline, request, frame, MapFeatures.of(pipeline))
    (match,) = verify_candidates(pipeline, request, raw)
    return match


def test_a_picture_of_the_same_spot_hardly_differs(pipeline):
    picture = panorama(1)
    match = answer(pipeline, np.roll(picture, -256, axis=1), picture)
    assert match.status == "no_baseline"
    assert match.differences.max() < 10.0


def test_what_was_changed_there_shows(pipeline):
    picture, changed = panorama(1), panorama(1)
    changed[300:420, 400:560] = changed[300:420, 400:560, ::-1]
    assert answer(pipeline, picture, changed).differences.max() > 20.0


def test_a_picture_of_another_place_is_not_compared(pipeline):
    match = answer(pipeline, panorama(1), panorama(2))
    assert match.yaw_rad is None
    assert match.differences is None
