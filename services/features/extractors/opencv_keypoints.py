"""OpenCV key points <-> continuous pixels; OpenCV counts from the centre of the first pixel."""

from collections.abc import Sequence
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt

from services.features.pipeline.interfaces import Detections, Image, IndexArray


def detections_from_keypoints(keypoints: Sequence[Any]) -> Detections:
    """Wrap cv2.KeyPoint objects."""
    pixels = np.array([k.pt for k in keypoints], dtype=np.float64).reshape(-1, 2) + 0.5
    scores = np.array([k.response for k in keypoints], dtype=np.float32)
    sizes = np.array([k.size for k in keypoints], dtype=np.float32)
    return Detections(pixels, scores, tuple(keypoints), sizes)


def describe_chosen(
    descriptor: Any,
    gray: Image,
    detections: Detections,
    chosen: IndexArray,
    width: int,
    upright: bool = False,
    surroundings: float = 1.0,
) -> tuple[IndexArray, npt.NDArray[Any]]:
    """Let `descriptor` describe the chosen key points; it may drop some, so each carries its index along.

    Args:
        descriptor: a cv2.Feature2D.
        gray: the view they were found in.
        detections: as returned by detections_from_keypoints.
        chosen: indices of those to describe.
        width: D, the width of an empty answer.
        upright: describe them without turning them.
        surroundings: side of what is described relative to the keypoint's own size.
    """
    keypoints = []
    for index in chosen:
        keypoint = detections.handle[index]
        angle = 0.0 if upright else keypoint.angle
        size = keypoint.size * surroundings
        (x, y), response, octave = keypoint.pt, keypoint.response, keypoint.octave
        keypoints.append(cv2.KeyPoint(x, y, size, angle, response, octave, int(index)))
    if not keypoints:
        return chosen, np.zeros((0, width), np.uint8)
    described, descriptors = descriptor.compute(gray, keypoints)
    if not described:
        return chosen[:0], np.zeros((0, width), np.uint8)
    return np.array([k.class_id for k in described], dtype=np.intp), np.asarray(descriptors)
