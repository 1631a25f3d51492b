"""How far a panorama is from level, by the upright edges of what it shows. Pure.

What is straight in the world lies on a great circle of the panorama, and the gradient of brightness along it
is normal to that circle. Walls, doors and furniture have upright edges, whose normals are at right angles to
up: the direction u for which  (g . u)^2  is least, summed over the gradients g that nearly fulfil it.
"""

import math
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from shared.geometry.perspective import pixel_centres
from shared.geometry.sphere import EquirectGrid, FloatArray, angle_between_rad, bearings_from_lonlat

Image = npt.NDArray[np.uint8]

WIDTH_PX = 1024
"""Most columns it is looked for at; chosen: a third of a degree each, and gradients take 0.2 s."""
LATITUDE_RAD = math.radians(50.0)
"""Further up and down columns crowd, and tripods and ceilings have edges of their own; chosen."""
WIDEST_LEAN_RAD = math.radians(25.0)
"""Chosen: more is a mount that somebody chose, and known roughly."""
BLUR_PX = 1.5
EDGE_LEVELS = 4.0
"""Of 255, from one pixel to the next; chosen: above the noise of a sensor after the blur."""
SECTORS, PER_SECTOR = 16, 1500
"""Strongest edges taken of each part of the horizon; chosen: so that no one window decides."""
GRID_RAD = math.radians(1.0)
NEAR_RAD = math.radians(1.5)
"""An edge this near to upright counts; chosen: what the gradient of one pixel is off by."""
STEPS = 10
PARTS = 8
"""Of the horizon, each left out once, for the standard deviation."""
FEWEST = 400
SHARE = 0.12
"""Least share of the edges that must be upright; chosen: of gradients in all directions 0.04 are."""
BIAS_RAD = math.radians(0.3)
"""What gradients are off by together, on painted rooms whose lean is known: pixels have rows and columns."""
SUREST_RAD = math.radians(1.0)
"""A level that is less sure than this is none; chosen: a tenth of what cameras may lean by."""


@dataclass(frozen=True, eq=False)
class Level:
    """Where up is.

    Attributes:
        up: unit vector (3,) in the panorama's frame (x ahead, y left, z up). Edges do not tell up from down.
        std_rad: its standard deviation, in either direction.
    """

    up: FloatArray
    std_rad: float

    @property
    def lean_rad(self) -> float:
        """Angle between it and the panorama's own up."""
        return float(angle_between_rad(self.up, np.array([0.0, 0.0, 1.0])))


def level_of(panorama: Image) -> Level | None:
    """Where up is in a panorama, (H, 2H, 3) BGR or (H, 2H) grey; None where too few edges are upright."""
    normals, sectors = _edge_normals(panorama)
    if len(normals) < FEWEST:
        return None
    up = _refined(normals, _searched(normals))
    upright = np.abs(normals @ up) < math.sin(NEAR_RAD)
    if upright.sum() < max(FEWEST, SHARE * len(normals)):
        return None
    others = [_refined(normals[sectors % PARTS != part], up) for part in range(PARTS)]
    variance = (PARTS - 1) / PARTS * float(np.sum((np.array(others) - np.mean(others, axis=0)) ** 2))
    std_rad = math.sqrt(variance / 2.0)  # jackknife (B. Efron, 1982); two directions
    return Level(up, math.hypot(std_rad, BIAS_RAD)) if std_rad < SUREST_RAD else None


def _edge_normals(panorama: Image) -> tuple[FloatArray, npt.NDArray[np.intp]]:
    """Normals (N, 3) of the great circles of edges that may be upright, and in which sectors these are."""
    width = min(WIDTH_PX, panorama.shape[1])
    height = width // 2
    grey = panorama if panorama.ndim == 2 else cv2.cvtColor(panorama, cv2.COLOR_BGR2GRAY)
    grey = cv2.resize(grey, (width, height), interpolation=cv2.INTER_AREA)
    wide = cv2.copyMakeBorder(grey, 0, 0, 8, 8, cv2.BORDER_WRAP).astype(np.float32)
    wide = cv2.GaussianBlur(wide, (0, 0), BLUR_PX)
    right, down = (cv2.Sobel(wide, cv2.CV_32F, x, 1 - x, ksize=3)[:, 8:-8] / 8.0 for x in (1, 0))
    lonlat = EquirectGrid(width, height).lonlat_from_pixels(pixel_centres(width, height))
    lon, lat = lonlat[..., 0], lonlat[..., 1]
    # Longitude grows to the left and latitude upwards, a column is as many radians as a row.
    east, north = -right / np.maximum(np.cos(lat), 1e-6), -down
    strength = np.hypot(east, north)
    outward = bearings_from_lonlat(lonlat)
    easterly = np.stack([-np.sin(lon), np.cos(lon), np.zeros_like(lon)], axis=-1)
    gradient = east[..., None] * easterly + north[..., None] * np.cross(outward, easterly)
    normal = gradient / np.maximum(strength, 1e-6)[..., None]
    may = (np.abs(lat) < LATITUDE_RAD) & (np.hypot(right, down) > EDGE_LEVELS)
    may &= np.abs(normal[..., 2]) < math.sin(WIDEST_LEAN_RAD + NEAR_RAD)
    rows, columns = np.nonzero(may)
    sectors = columns * SECTORS // width
    kept = [_strongest(np.flatnonzero(sectors == one), strength[rows, columns]) for one in range(SECTORS)]
    chosen = np.concatenate(kept)
    return normal[rows[chosen], columns[chosen]], sectors[chosen]


def _strongest(places: npt.NDArray[np.intp], strength: FloatArray) -> npt.NDArray[np.intp]:
    return places[np.argsort(-strength[places], kind="stable")[:PER_SECTOR]]


def _searched(normals: FloatArray) -> FloatArray:
    """The direction of a grid that most edges are upright to."""
    tangents = np.tan(np.arange(-WIDEST_LEAN_RAD, WIDEST_LEAN_RAD + 1e-9, GRID_RAD))
    x, y = (axis.ravel() for axis in np.meshgrid(tangents, tangents))
    ups = np.stack([x, y, np.ones_like(x)], axis=-1)
    ups /= np.linalg.norm(ups, axis=-1, keepdims=True)
    some = normals[:: max(1, len(normals) // 4000)]
    counts = np.zeros(len(ups))
    for one in np.array_split(some, 8):
        counts += (np.abs(ups @ one.T) < math.sin(NEAR_RAD)).sum(axis=1)
    return np.asarray(ups[int(np.argmax(counts))], dtype=np.float64)


def _refined(normals: FloatArray, up: FloatArray) -> FloatArray:
    """Least squares over the edges that are nearly upright, again and again."""
    for _ in range(STEPS):
        near = normals[np.abs(normals @ up) < math.sin(2.0 * NEAR_RAD)]
        _, vectors = np.linalg.eigh(near.T @ near)
        up = vectors[:, 0] * (1.0 if vectors[2, 0] >= 0.0 else -1.0)
    return np.asarray(up, dtype=np.float64)
