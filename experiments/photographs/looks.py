"""Picture files to features, by the way that a robot's pictures go; tilted ones are re-rendered first."""

import time
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

import cv2
import numpy as np

from experiments.photographs.tilting import tilt
from services.features.matching.verification import feature_set
from services.features.pipeline.interfaces import FeatureSet, Image
from services.features.pipeline.pipeline import Pipeline
from services.launcher.client.failure import ExperimentError
from shared.jpeg import BadPictureError, jpeg_size
from shared.messages.sensors import Frame

TILTED_JPEG_QUALITY = 95
"""Of re-rendered pictures; chosen: cameras write as finely, and both pictures of a pair are decoded alike."""

JPEG_MARK = b"\xff\xd8"


@dataclass(frozen=True)
class Look:
    """A picture to extract, and how its camera is tilted first (nose down, left up), radians."""

    path: Path
    pitch_rad: float = 0.0
    roll_rad: float = 0.0


class Seen(NamedTuple):
    """Features of a picture, and the time to decode and extract it, milliseconds."""

    features: FeatureSet
    ms: float


def seen(look: Look, pipeline: Pipeline) -> Seen:
    """Features of a picture.

    Raises:
        ExperimentError: it cannot be decoded.
    """
    try:
        data = look.path.read_bytes()
        if look.pitch_rad or look.roll_rad:
            data = _jpeg(tilt(picture_of(look.path), look.pitch_rad, look.roll_rad))
        began_s = time.perf_counter()
        features = feature_set(pipeline.features_of(_frame(data)))
    except BadPictureError as error:
        raise ExperimentError(f"{look.path}: {error}: export the picture again") from error
    return Seen(features, 1000.0 * (time.perf_counter() - began_s))


def picture_of(path: Path) -> Image:
    """The picture of a file at its full size, (H, W, 3) BGR.

    Raises:
        BadPictureError: OpenCV cannot read it.
    """
    return _decoded(path.read_bytes())


def _decoded(data: bytes) -> Image:
    flags = cv2.IMREAD_COLOR | cv2.IMREAD_IGNORE_ORIENTATION
    picture = cv2.imdecode(np.frombuffer(data, np.uint8), flags)
    if picture is None:
        raise BadPictureError("its data are damaged")
    return np.asarray(picture, np.uint8)


def _jpeg(picture: Image) -> bytes:
    _, data = cv2.imencode(".jpg", picture, [cv2.IMWRITE_JPEG_QUALITY, TILTED_JPEG_QUALITY])
    return bytes(data.tobytes())


def _frame(data: bytes) -> Frame:
    """The message that a robot would send of a picture: a JPEG as it is, anything else decoded."""
    if data.startswith(JPEG_MARK):
        width_px, height_px = jpeg_size(data)
        return Frame(robot="study", encoding="jpeg", width_px=width_px, height_px=height_px, data=data)
    picture = _decoded(data)
    height_px, width_px = picture.shape[:2]
    return Frame(
        robot="study", encoding="bgr8", width_px=width_px, height_px=height_px, data=picture.tobytes()
    )
