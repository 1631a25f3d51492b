"""Eighty flat pictures round the sphere, each with little distortion (Eder et al. 2020; thesis 2.2.1.2).

Every picture touches the sphere at the centre of one face of a subdivided icosahedron and is a little larger
than the face; keypoints are reported only by the face they lie in, hence each once.
"""

import cv2
import numpy as np
import numpy.typing as npt

from services.features.pipeline.interfaces import BoolArray, FloatArray, Image, Profile, View
from services.features.representations.strip import cropped_strip
from shared.geometry.icosahedron import tangent_layout
from shared.geometry.perspective import view_table
from shared.geometry.sphere import EquirectGrid, lonlat_from_bearings

BASE_LEVEL, SUBDIVISION = 9, 1
"""Eighty pictures of 256 x 256 (thesis, section 2.2.1.2)."""


class Tangent:
    """Tangent pictures of the faces that show anything of the uncropped band."""

    def __init__(self, profile: Profile) -> None:
        self._profile = profile
        self._layout = tangent_layout(BASE_LEVEL, SUBDIVISION)
        latitudes = lonlat_from_bearings(self._layout.triangles)[..., 1]
        limit = np.deg2rad(90.0 - profile.crop_deg)
        self._faces = np.flatnonzero(np.abs(latitudes).min(axis=1) < limit).tolist()
        self._tables: dict[EquirectGrid, tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]] = {}

    def views(self, gray: Image) -> list[View]:
        """One view per face, north upwards. Rows cut away repeat the last one kept: no edge to be found."""
        strip, grid = cropped_strip(gray, self._profile.crop_deg, self._profile.resize)
        map_x, map_y = self._table(grid)
        stacked = np.asarray(
            cv2.remap(strip, map_x, map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_WRAP), np.uint8
        )
        pictures = np.split(stacked, len(self._faces))
        return [self._view(face, picture) for face, picture in zip(self._faces, pictures, strict=True)]

    def _view(self, face: int, picture: Image) -> View:
        def owns(pixels: FloatArray) -> BoolArray:
            return self._layout.owned(face, pixels)

        view = self._layout.views[face]
        return View(picture, 1.0 / view.focal_px, view.lonlat_from_pixels, owns)

    def _table(self, grid: EquirectGrid) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]:
        """Remap tables of all faces, one below the other, kept for the newest picture size."""
        if grid not in self._tables:
            tables = [view_table(self._layout.views[face], grid) for face in self._faces]
            self._tables = {
                grid: (np.concatenate([t.map_x for t in tables]), np.concatenate([t.map_y for t in tables]))
            }
        return self._tables[grid]
