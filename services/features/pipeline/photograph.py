"""Photo -> features like those of panoramas. Pure.

A photo is drawn as the part of a panorama that it shows, at the panoramas' resolution, so that extractor,
descriptors and matching are theirs. Round it its border goes on: what touches it is no keypoint.
"""

import math

import cv2
import numpy as np

from services.features.pipeline.extraction import strongest
from services.features.pipeline.interfaces import Extractor, FeatureSet, FloatArray, Image, Profile
from shared.geometry.photo.plane import focal_of
from shared.geometry.sphere import bearings_from_lonlat
from shared.messages.features import PhotoView

KEYPOINTS = 2500
"""Most of a photo: of a node's only some lie in it, and which ones nobody knows."""
BORDER_SIZES = 0.5
"""Sizes of a keypoint that must lie between it and the photo's border."""
NATIVE_COLUMNS = 1024
"""Of a panorama where a pipeline takes pictures as they come; that of the simulated camera."""
SMOOTH = 1.6
"""Pixels of the shrunk photo for one that is drawn: bilinear sampling of more would alias."""


def extract_photo(picture: Image, view: PhotoView, extractor: Extractor, profile: Profile) -> FeatureSet:
    """Find and describe keypoints of a photo.

    Args:
        picture: (H, W, 3) BGR or (H, W) grey, upright.
        view: its camera.
        extractor: finds and describes.
        profile: resolution of the panoramas.

    Returns:
        At most KEYPOINTS features, strongest first; longitude and latitude as of a camera of `view.fov_rad`
        that looks to 0, 0.
    """
    gray = picture if picture.ndim == 2 else np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), np.uint8)
    columns = profile.resize[1] if profile.resize is not None else NATIVE_COLUMNS
    px_per_rad = columns / math.tau
    focal_px = focal_of(view.fov_rad) * max(gray.shape) / 2.0
    drawn, corner = _drawn(gray, focal_px, px_per_rad)
    (found,) = extractor.detect([drawn])
    lonlat = (np.asarray(corner) - found.pixels) / px_per_rad
    inside = _border_px(lonlat, gray, focal_px)
    sizes = np.zeros(len(lonlat), np.float32) if found.sizes is None else found.sizes
    rows = np.flatnonzero(inside > BORDER_SIZES * sizes * focal_px / px_per_rad)
    rows = rows[strongest(lonlat[rows], found.scores[rows], KEYPOINTS)]
    kept, descriptors = extractor.describe(drawn, found, rows)
    sizes_rad = None if found.sizes is None else found.sizes[kept] / np.float32(px_per_rad)
    return FeatureSet(lonlat[kept].astype(np.float32), found.scores[kept], descriptors, sizes_rad)


def _drawn(gray: Image, focal_px: float, px_per_rad: float) -> tuple[Image, tuple[float, float]]:
    """Its part of a panorama, and the pixel of that which longitude and latitude 0 fall on."""
    height, width = gray.shape
    shrink = min(1.0, SMOOTH * px_per_rad / focal_px)
    size = max(1, round(width * shrink)), max(1, round(height * shrink))
    small = cv2.resize(gray, size, interpolation=cv2.INTER_AREA) if shrink < 1.0 else gray
    columns = max(1, int(2.0 * math.atan(width / 2.0 / focal_px) * px_per_rad))
    rows = max(1, int(2.0 * math.atan(height / 2.0 / focal_px) * px_per_rad))
    corner = columns / 2.0, rows / 2.0
    u, v = np.meshgrid(np.arange(columns) + 0.5, np.arange(rows) + 0.5)
    pixels = _pixels(np.stack([corner[0] - u, corner[1] - v], axis=-1) / px_per_rad, width, height, focal_px)
    scaled = pixels * np.array([size[0] / width, size[1] / height]) - 0.5
    map_x, map_y = scaled[..., 0].astype(np.float32), scaled[..., 1].astype(np.float32)
    drawn = cv2.remap(small, map_x, map_y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(drawn, np.uint8), corner


def _pixels(lonlat: FloatArray, width: int, height: int, focal_px: float) -> FloatArray:
    """Pixels (..., 2) of the photo at which (..., 2) longitudes and latitudes are seen."""
    ray = bearings_from_lonlat(lonlat)
    middle = np.array([width / 2.0, height / 2.0])
    return np.asarray(middle - focal_px * ray[..., 1:] / ray[..., :1], np.float64)


def _border_px(lonlat: FloatArray, gray: Image, focal_px: float) -> FloatArray:
    """How far (N,) inside the photo's border each direction is seen, pixels of the photo."""
    height, width = gray.shape
    pixels = _pixels(lonlat, width, height, focal_px)
    return np.asarray(np.minimum(pixels, np.array([width, height]) - pixels).min(axis=1), np.float64)
