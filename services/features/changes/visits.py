"""A frame compared with an earlier picture of its place: turned alike by keypoints, then by regions."""

import time

import cv2
import numpy as np

from services.features.changes.comparison import changed_regions
from services.features.matching.verification import Candidate, feature_set, verify
from services.features.pipeline.interfaces import Image
from services.features.pipeline.pipeline import Pipeline
from shared.frames.decoding import decode_picture
from shared.jpeg import BadPictureError, jpeg_size
from shared.messages.features import Features
from shared.messages.inspections import CompareReply
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Frame

QUALITY = 85
"""Of pictures that are kept, JPEG percent; chosen: 150 kB for 1024 x 512 pixels."""
LEAST_INLIERS = 12
"""Keypoints that must agree for a turn; chosen; of 189 pairs of spots at one place one had fewer."""


def compare_with(pipeline: Pipeline, frame: Frame, features: Features, reference: bytes) -> CompareReply:
    """The frame as a picture, and what changed in it.

    Args:
        pipeline: that made `features`, and makes those of the reference.
        frame: the picture of now.
        features: of the frame.
        reference: JPEG of the earlier picture; empty for none.

    Raises:
        BadPictureError: one of the two is no picture.
    """
    start_s = time.perf_counter()
    picture = decode_picture(frame)
    reply = CompareReply(seq=features.seq, stamp_ns=features.stamp_ns, picture=_as_jpeg(frame, picture))
    if not reference:
        return reply.model_copy(update={"why": "no earlier picture"})
    earlier = _frame_of(reference)
    match = match_of(pipeline, features, earlier)
    facts = {"inliers": match.inliers, "disparity_rad": match.disparity_rad}
    if match.yaw_rad is None or match.inliers < LEAST_INLIERS:
        why = f"{match.inliers} keypoints agree with the earlier picture, at least {LEAST_INLIERS} expected"
        return reply.model_copy(update={**facts, "why": why})
    yaw_rad, disparity_rad = -match.yaw_rad, match.disparity_rad or 0.0
    found = changed_regions(decode_picture(earlier), picture, yaw_rad, disparity_rad)
    took_ms = (time.perf_counter() - start_s) * 1e3
    told = {"compared": True, "yaw_rad": yaw_rad, "regions": tuple(found), "took_ms": took_ms}
    return reply.model_copy(update={**facts, **told})


def match_of(pipeline: Pipeline, features: Features, earlier: Frame) -> NodeMatch:
    """How the camera turned and moved between an earlier picture and a frame with these features."""
    now, before = feature_set(features), feature_set(pipeline.features_of(earlier))
    (pairs,) = pipeline.matcher.match(now, [before])
    return verify(now, Candidate(0, before), pairs, features.seq, pipeline.verification, False)


def _frame_of(jpeg: bytes) -> Frame:
    width_px, height_px = jpeg_size(jpeg)
    if width_px != 2 * height_px:
        raise BadPictureError(f"earlier picture must be twice as wide as high, got {width_px} x {height_px}")
    return Frame(robot="earlier", encoding="jpeg", width_px=width_px, height_px=height_px, data=jpeg)


def _as_jpeg(frame: Frame, picture: Image) -> bytes:
    if frame.encoding == "jpeg":
        return frame.data
    done, encoded = cv2.imencode(".jpg", picture, (cv2.IMWRITE_JPEG_QUALITY, QUALITY))
    if not done:
        raise BadPictureError(f"a picture of {picture.shape} cannot be written as JPEG")
    return np.asarray(encoded, np.uint8).tobytes()
