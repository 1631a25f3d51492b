"""Phone pictures at random poses of a world: cut out of panorama, turned, of any field of view. Pure."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np

from shared.geometry.perspective import pixel_centres, rotation_y
from shared.geometry.photo.exif import fov_of_film
from shared.geometry.photo.plane import focal_of
from shared.geometry.sphere import EquirectGrid, FloatArray
from shared.messages.features import Photo, PhotoView
from shared.messages.simulation import Pose
from simulator.sensors.panorama import Image

LONG_PX, SHORT_PX = 1600, 1200
"""Of a picture; chosen: 4:3, as phones take them."""
PITCH_RAD, ROLL_RAD = math.radians(15.0), math.radians(5.0)
"""Up to which a phone leans, evenly; so people hold it."""
FOV_RAD = (math.radians(50.0), math.radians(110.0))
"""Fields of view over the longer side, evenly: of the lenses of phones but for tele."""
QUALITY = 90
"""Of the JPEG that it was."""


@dataclass(frozen=True)
class Shot:
    """How a picture was taken.

    Attributes:
        pose: where, and which way it looks.
        pitch_rad: upwards; roll_rad: about the line of sight.
        fov_rad: over the longer side; fov_known: whether the picture says it.
        portrait: higher than wide.
    """

    pose: Pose
    pitch_rad: float
    roll_rad: float
    fov_rad: float
    fov_known: bool
    portrait: bool

    @property
    def size_px(self) -> tuple[int, int]:
        """Width and height."""
        return (SHORT_PX, LONG_PX) if self.portrait else (LONG_PX, SHORT_PX)


def shots_at(poses: list[Pose], rng: np.random.Generator) -> list[Shot]:
    """One picture from each pose; every other one says its field of view."""
    return [
        Shot(
            pose,
            rng.uniform(-PITCH_RAD, PITCH_RAD),
            rng.uniform(-ROLL_RAD, ROLL_RAD),
            rng.uniform(*FOV_RAD),
            fov_known=number % 2 == 0,
            portrait=bool(rng.random() < 0.5),
        )
        for number, pose in enumerate(poses)
    ]


def taken(shot: Shot, panorama: Callable[[Pose], Image], usual_fov_rad: float) -> Photo:
    """The picture, out of the panorama that a level camera with the same heading takes there.

    Args:
        shot: how.
        panorama: renders one, (H, 2H, 3) BGR.
        usual_fov_rad: what is assumed where the picture does not say it.
    """
    image = panorama(shot.pose)
    width, height = shot.size_px
    middle = np.array([width / 2.0, height / 2.0])
    focal_px = focal_of(shot.fov_rad) * LONG_PX / 2.0
    aside = middle - pixel_centres(width, height)
    ray = np.concatenate([np.full((height, width, 1), focal_px), aside], axis=2)
    turned = ray @ (rotation_y(-shot.pitch_rad) @ rotation_x(shot.roll_rad)).T
    source = EquirectGrid(image.shape[1], image.shape[0]).pixels_from_bearings(turned) - 0.5
    cut = cv2.remap(
        image,
        source[..., 0].astype(np.float32),
        source[..., 1].astype(np.float32),
        cv2.INTER_CUBIC,
        borderMode=cv2.BORDER_WRAP,
    )
    _, coded = cv2.imencode(".jpg", cut, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
    pixels = np.asarray(cv2.imdecode(coded, cv2.IMREAD_COLOR), np.uint8)
    fov_rad = in_whole_millimetres(shot.fov_rad) if shot.fov_known else usual_fov_rad
    view = PhotoView(fov_rad=fov_rad, fov_known=shot.fov_known, aspect=width / height)
    return Photo(view=view, width_px=width, height_px=height, data=pixels.tobytes())


def in_whole_millimetres(fov_rad: float) -> float:
    """A field of view as EXIF tells it: by a focal length in 35 mm film, whole millimetres."""
    of_one_mm = fov_of_film(1.0, LONG_PX, SHORT_PX)
    focal_mm = round(math.tan(of_one_mm / 2.0) / math.tan(fov_rad / 2.0))
    return fov_of_film(focal_mm, LONG_PX, SHORT_PX)


def rotation_x(angle_rad: float) -> FloatArray:
    """Rotation about x, (3, 3): rolls a camera's left side upwards."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
