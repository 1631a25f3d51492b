"""Six cube faces -> one equirectangular picture, with one precomputed table. Pure numpy and OpenCV.

Axes: x forward, y left, z up. Column c of a W-wide picture looks at longitude pi - 2 pi (c + 0.5) / W: the
centre ahead, column 0 and the seam backwards, left of the centre to the left. Row r looks at latitude
pi / 2 - pi (r + 0.5) / H. Faces are seen a little wider than 90 degrees, so that every sample interpolates
within one face and no border shows.
"""

import math
from functools import cached_property

import cv2
import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
Float32Array = npt.NDArray[np.float32]
Image = npt.NDArray[np.uint8]
BORDER_PX = 2  # beyond 90 degrees on each side of a face: bilinear sampling needs one, rounding another

# Forward and left axis of each face, in the camera frame.
FACE_AXES: tuple[tuple[tuple[int, int, int], tuple[int, int, int]], ...] = (
    ((1, 0, 0), (0, 1, 0)),
    ((0, 1, 0), (-1, 0, 0)),
    ((-1, 0, 0), (0, -1, 0)),
    ((0, -1, 0), (1, 0, 0)),
    ((0, 0, 1), (0, 1, 0)),
    ((0, 0, -1), (0, 1, 0)),
)


def face_rotations() -> list[FloatArray]:
    """Rotation from each face's frame (x forward, y left, z up) to the camera frame, (3, 3) each."""
    rotations = []
    for forward, left in FACE_AXES:
        f, side = np.array(forward, float), np.array(left, float)
        rotations.append(np.stack([f, side, np.cross(f, side)], axis=-1))
    return rotations


def face_fov_rad(face_px: int) -> float:
    """Field of view of a face whose inner face_px - 2 BORDER_PX pixels span 90 degrees."""
    return 2.0 * math.atan(face_px / (face_px - 2 * BORDER_PX))


def directions(width_px: int) -> FloatArray:
    """Unit vectors of all pixel centres, (width / 2, width, 3)."""
    height = width_px // 2
    longitude = math.pi - 2.0 * math.pi * (np.arange(width_px) + 0.5) / width_px
    latitude = math.pi / 2 - math.pi * (np.arange(height) + 0.5) / height
    cos_lat = np.cos(latitude)[:, None]
    return np.stack(
        [
            cos_lat * np.cos(longitude),
            cos_lat * np.sin(longitude),
            np.broadcast_to(np.sin(latitude)[:, None], (height, width_px)),
        ],
        axis=-1,
    )


class CubeToEquirect:
    """Resampling table for one picture size."""

    def __init__(self, width_px: int, face_px: int) -> None:
        """Make the table for faces stacked under one another: (6 * face_px, face_px)."""
        self.width_px, self.face_px = width_px, face_px
        rays = directions(width_px)
        scores = np.stack([rays @ np.array(forward, float) for forward, _ in FACE_AXES], axis=-1)
        face = scores.argmax(axis=-1)
        focal = (face_px - 2 * BORDER_PX) / 2.0
        u, v = np.empty(face.shape), np.empty(face.shape)
        for k, rotation in enumerate(face_rotations()):
            chosen = face == k
            local = rays[chosen] @ rotation
            u[chosen] = face_px / 2.0 - focal * local[:, 1] / local[:, 0] - 0.5
            v[chosen] = face_px / 2.0 - focal * local[:, 2] / local[:, 0] - 0.5 + k * face_px
        self._map, self._weights = cv2.convertMaps(u.astype(np.float32), v.astype(np.float32), cv2.CV_16SC2)
        self._source, self._forward = (u, v), scores.max(axis=-1).astype(np.float32)

    def __call__(self, faces: Image) -> Image:
        """Resample (6 * face_px, face_px, channels) bytes to (width / 2, width, channels)."""
        if faces.shape[:2] != (6 * self.face_px, self.face_px):
            raise ValueError(
                f"faces must have shape ({6 * self.face_px}, {self.face_px}, channels), got {faces.shape}"
            )
        return np.asarray(cv2.remap(faces, self._map, self._weights, cv2.INTER_LINEAR), np.uint8)

    def ranges(self, depths_m: Float32Array) -> Float32Array:
        """Metres along the ray of each pixel, (width / 2, width), from depths along the axes of the faces.

        The nearest sample of a face counts: between two, an edge would get a range at which nothing is.

        Args:
            depths_m: (6 * face_px, face_px), stacked as the pictures are.
        """
        return np.asarray(depths_m.ravel()[self._nearest] / self._forward, np.float32)

    @cached_property
    def _nearest(self) -> npt.NDArray[np.intp]:
        column, row = (np.rint(axis).astype(np.intp) for axis in self._source)
        return row * self.face_px + column
