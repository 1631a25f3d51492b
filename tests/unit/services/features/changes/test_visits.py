"""A frame compared with an earlier picture: the turn is found, and what cannot be compared is said."""

import cv2
import numpy as np
import pytest

from services.features.changes.visits import compare_with
from services.features.pipeline.named_pipelines import find_profile
from services.features.pipeline.pipeline import Pipeline
from shared.jpeg import BadPictureError
from shared.messages.sensors import Frame
from tests.unit.services.features import room

HEIGHT_PX = 256


@pytest.fixture(scope="module")
def pipeline():
    return Pipeline(find_profile("sift"))


def jpeg(picture):
    return cv2.imencode(".jpg", picture)[1].tobytes()


def frame_of(picture):
    height_px, width_px = picture.shape[:2]
    return Frame(
        seq=4, robot="r1", encoding="bgr8", width_px=width_px, height_px=height_px, data=picture.tobytes()
    )


@pytest.fixture(scope="module")
def now():
    return frame_of(room.render_room(0.05, 0.02, 1.5, HEIGHT_PX))


def compared(pipeline, frame, reference):
    return compare_with(pipeline, frame, pipeline.features_of(frame), reference)


def test_the_turn_between_both_cameras_is_found_and_nothing_differs(pipeline, now):
    reply = compared(pipeline, now, jpeg(room.render_room(0.0, 0.0, 0.0, HEIGHT_PX)))
    assert reply.compared
    assert reply.yaw_rad == pytest.approx(1.5, abs=0.03)
    assert reply.regions == ()
    assert (reply.seq, reply.inliers > 30) == (4, True)


def test_without_an_earlier_picture_the_frame_is_sent_as_one(pipeline, now):
    reply = compared(pipeline, now, b"")
    assert (reply.compared, reply.why) == (False, "no earlier picture")
    shown = cv2.imdecode(np.frombuffer(reply.picture, np.uint8), cv2.IMREAD_COLOR)
    assert np.abs(shown.astype(int) - np.frombuffer(now.data, np.uint8).reshape(shown.shape)).mean() < 8


def test_another_place_is_not_compared(pipeline, now):
    noise = np.random.default_rng(0).integers(0, 256, (HEIGHT_PX, 2 * HEIGHT_PX, 3), dtype=np.uint8)
    reply = compared(pipeline, now, jpeg(cv2.GaussianBlur(noise, (0, 0), 2)))
    assert not reply.compared
    assert "keypoints agree" in reply.why
    assert reply.regions == ()


@pytest.mark.parametrize("bad", [b"no picture", jpeg(np.zeros((64, 64, 3), np.uint8))])
def test_what_is_no_panorama_is_refused(pipeline, now, bad):
    with pytest.raises(BadPictureError):
        compared(pipeline, now, bad)
