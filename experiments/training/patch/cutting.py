"""Corners at several scales and the patches around them, as kornia cuts them for the feature service. Pure.

The same figures as `kornia.feature.MultiResolutionDetector` and `extract_patches_from_pyramid`, with OpenCV.
"""

import math
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from services.features.pipeline.interfaces import Float32Array, FloatArray, Image

PATCH_PX = 32
"""Side of a patch, as all of kornia's descriptors take them."""
HALF_PX = 22.0
"""Half the side of what a patch covers, in pixels of the level where its corner was found."""
STEP, FINEST, COARSEST = math.sqrt(2.0), -1, 4
"""Levels: by how much each is smaller than the one before, and the first and last, the picture being 0."""
WINDOW_PX, MARGIN_PX = 15, 15
"""A corner is the strongest in this window, and so far from the sides of its level."""
KERNEL = np.array([1.0, 4.0, 6.0, 4.0, 1.0]) / 16.0
AT_ONCE = 500
"""Patches cut by one call of OpenCV, which takes at most 2^15 rows."""


@dataclass(frozen=True, eq=False)
class Frames:
    """Upright squares of a picture, one a patch.

    Attributes:
        pixels: (N, 2) continuous pixels of their centres, the first pixel's centre being 0.5.
        halves_px: (N,) half their sides.
    """

    pixels: FloatArray
    halves_px: FloatArray

    def __len__(self) -> int:
        return len(self.halves_px)

    def __getitem__(self, rows: npt.NDArray[np.intp] | npt.NDArray[np.bool_]) -> "Frames":
        return Frames(self.pixels[rows], self.halves_px[rows])


def corners(gray: Image, count: int) -> Frames:
    """The strongest corners (Shi and Tomasi) of all levels, strongest first.

    Args:
        gray: (H, W) picture.
        count: most to take.
    """
    height, width = gray.shape
    here = gray.astype(np.float32) / 255.0
    scores, pixels, halves = [], [], []
    for level in range(FINEST, COARSEST + 1):
        if level < 0:
            size = int(width * STEP), int(height * STEP)
            picture = cv2.resize(here, size, interpolation=cv2.INTER_LINEAR)
        else:
            here = picture = here if level == 0 else _reduced(here, STEP)
        response = _response(picture)
        rows, columns = _peaks(response)
        factor = np.array([width / picture.shape[1], height / picture.shape[0]])
        scores.append(response[rows, columns])
        pixels.append(np.stack([columns, rows], axis=-1) * factor + 0.5)
        halves.append(np.full(len(rows), HALF_PX * factor.mean()))
    order = np.argsort(-np.concatenate(scores), kind="stable")[:count]
    return Frames(np.concatenate(pixels)[order], np.concatenate(halves)[order])


def patches(gray: Image, frames: Frames, turns_rad: FloatArray | None = None) -> npt.NDArray[np.uint8]:
    """What the frames cover, (N, 32, 32), each from the level of an octave pyramid that suits its size.

    Args:
        gray: (H, W) picture; beyond its sides its outermost pixels go on.
        frames: N of them.
        turns_rad: (N,) by which each is turned, from x to y; None for none.
    """
    pyramid = [gray.astype(np.float32)]
    while min(pyramid[-1].shape) // 2 >= PATCH_PX:
        pyramid.append(_reduced(pyramid[-1], 2.0))
    octave = np.log2(2.0 * frames.halves_px / PATCH_PX)
    levels = np.clip(octave, 0, len(pyramid) - 1).astype(np.intp)
    turns = np.zeros(len(frames)) if turns_rad is None else turns_rad
    cut = np.zeros((len(frames), PATCH_PX, PATCH_PX), np.uint8)
    for number, picture in enumerate(pyramid):
        of_level = np.flatnonzero(levels == number)
        for begin in range(0, len(of_level), AT_ONCE):
            rows = of_level[begin : begin + AT_ONCE]
            cut[rows] = _cut(picture, frames[rows], turns[rows], gray.shape)
    return cut


def _cut(
    picture: Float32Array, frames: Frames, turns_rad: FloatArray, whole: tuple[int, ...]
) -> npt.NDArray[np.uint8]:
    """Patches from one level of a picture of (H, W) `whole`."""
    steps = (2.0 * np.arange(PATCH_PX) + 1.0) / PATCH_PX - 1.0
    right, down = np.meshgrid(steps, steps)
    along, across = ((frames.halves_px * of(turns_rad))[:, None, None] for of in (np.cos, np.sin))
    x = frames.pixels[:, 0, None, None] + along * right - across * down
    y = frames.pixels[:, 1, None, None] + across * right + along * down
    x, y = (
        (at * picture.shape[axis] / whole[axis] - 0.5).astype(np.float32).reshape(-1, PATCH_PX)
        for at, axis in ((x, 1), (y, 0))
    )
    found = cv2.remap(picture, x, y, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return np.asarray(np.clip(np.rint(found), 0, 255), np.uint8).reshape(-1, PATCH_PX, PATCH_PX)


def _reduced(picture: Float32Array, factor: float) -> Float32Array:
    blurred = cv2.sepFilter2D(picture, cv2.CV_32F, KERNEL, KERNEL, borderType=cv2.BORDER_REFLECT_101)
    size = int(picture.shape[1] / factor), int(picture.shape[0] / factor)
    return np.asarray(cv2.resize(blurred, size, interpolation=cv2.INTER_LINEAR), np.float32)


def _response(picture: Float32Array) -> Float32Array:
    """Smaller eigenvalue of the structure tensor."""
    x, y = (
        cv2.Sobel(picture, cv2.CV_32F, *order, scale=0.125, borderType=cv2.BORDER_REPLICATE)
        for order in ((1, 0), (0, 1))
    )
    xx, yy, xy = (
        cv2.GaussianBlur(product, (7, 7), 1.0, borderType=cv2.BORDER_REFLECT_101)
        for product in (x * x, y * y, x * y)
    )
    return np.asarray(0.5 * (xx + yy - np.sqrt((xx - yy) ** 2 + 4.0 * xy * xy)), np.float32)


def _peaks(response: Float32Array) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp]]:
    """Rows and columns of the maxima."""
    highest = cv2.dilate(response, np.ones((WINDOW_PX, WINDOW_PX), np.uint8))
    found = (response >= highest) & (response > 0.0)
    inside = np.zeros_like(found)
    inside[MARGIN_PX:-MARGIN_PX, MARGIN_PX:-MARGIN_PX] = True
    rows, columns = np.nonzero(found & inside)
    return rows, columns
