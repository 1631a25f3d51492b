"""One picture of a pair: the frame above, the candidate below, their matches, and two arrows. Pure."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from services.features.pipeline.interfaces import Image
from shared.geometry.sphere import EquirectGrid, FloatArray
from shared.messages.matching import NodeMatch

WIDTH_PX, CROP_DEG = 1280, 25.0
"""Of each panorama, and what is cut away above and below it: no keypoints are there."""

HEAD_PX, GAP_PX = 64, 34
INLIER, OTHER = (60, 200, 60), (150, 150, 150)
ANSWERED, TRUE = (0, 110, 255), (255, 180, 40)
INK, PAPER = (30, 30, 30), (255, 255, 255)
FAINT = 0.35


@dataclass(frozen=True)
class Caption:
    """Two lines above, and what gave the heading."""

    title: str
    figures: str
    method: str


def pair_picture(
    pictures: tuple[Image, Image],
    match: NodeMatch,
    answered_deg: float | None,
    true_deg: float | None,
    caption: Caption,
) -> Image:
    """The picture (H, WIDTH_PX, 3), BGR.

    Args:
        pictures: frame and candidate, equirectangular, any size.
        match: with its pairs of bearings; those that agree with one motion are drawn in colour.
        answered_deg: heading that was answered, counter-clockwise from the centre of the frame.
        true_deg: the known bearing.
        caption: text above.
    """
    grid = EquirectGrid.cropped(WIDTH_PX, WIDTH_PX // 2, CROP_DEG)
    tops = (HEAD_PX, HEAD_PX + grid.height + GAP_PX)
    canvas = np.full((tops[1] + grid.height, WIDTH_PX, 3), 255, np.uint8)
    for top, picture in zip(tops, pictures, strict=True):
        small = cv2.resize(picture, (WIDTH_PX, WIDTH_PX // 2), interpolation=cv2.INTER_AREA)
        canvas[top : top + grid.height] = small[grid.row_slice]
    _matches(canvas, match, grid, tops)
    below = tops[0] + grid.height
    for angle_deg, colour in ((true_deg, TRUE), (answered_deg, ANSWERED)):
        if angle_deg is not None:
            _arrow(canvas, angle_deg, below, colour)
    _text(canvas, caption.title, (10, 26), 0.7)
    _text(canvas, caption.figures, (10, 52), 0.55)
    _legend(canvas, answered_deg, true_deg, caption.method)
    return canvas


def _matches(canvas: Image, match: NodeMatch, grid: EquirectGrid, tops: Sequence[int]) -> None:
    """Lines between matched keypoints: the others faint and first, the inliers over them."""
    if match.matches_rad is None or match.inlier_mask is None:
        return
    ends = [
        grid.pixels_from_lonlat(match.matches_rad[:, k : k + 2]) + np.array([0.0, top])
        for k, top in zip((0, 2), tops, strict=True)
    ]
    inlier = match.inlier_mask.astype(bool)
    faint = canvas.copy()
    _lines(faint, ends[0][~inlier], ends[1][~inlier], OTHER)
    cv2.addWeighted(faint, FAINT, canvas, 1.0 - FAINT, 0.0, dst=canvas)
    _lines(canvas, ends[0][inlier], ends[1][inlier], INLIER)


def _lines(canvas: Image, starts: FloatArray, ends: FloatArray, colour: tuple[int, int, int]) -> None:
    for start, end in zip(
        starts.round().astype(int).tolist(), ends.round().astype(int).tolist(), strict=True
    ):
        cv2.line(canvas, start, end, colour, 1, cv2.LINE_AA)
        for point in (start, end):
            cv2.circle(canvas, point, 3, colour, -1, cv2.LINE_AA)


def _arrow(canvas: Image, angle_deg: float, below: int, colour: tuple[int, int, int]) -> None:
    """An arrow into the frame from below, at the column of a heading."""
    column = round(WIDTH_PX * (0.5 - angle_deg / 360.0)) % WIDTH_PX
    for ink, thickness in ((PAPER, 9), (colour, 5)):
        cv2.arrowedLine(
            canvas,
            (column, below + GAP_PX - 6),
            (column, below - 110),
            ink,
            thickness,
            cv2.LINE_AA,
            tipLength=0.25,
        )


def _legend(canvas: Image, answered_deg: float | None, true_deg: float | None, method: str) -> None:
    """What the arrows are, at the right of the text."""
    answered = (
        f"answered {round(answered_deg):+d} deg by {method}" if answered_deg is not None else "no answer"
    )
    true = (
        f"true bearing {round(true_deg):+d} deg" if true_deg is not None else "different places: no bearing"
    )
    for row, (text, colour) in enumerate(((answered, ANSWERED), (true, TRUE))):
        y = 24 + 26 * row
        cv2.arrowedLine(
            canvas, (WIDTH_PX - 330, y + 3), (WIDTH_PX - 330, y - 15), colour, 4, cv2.LINE_AA, tipLength=0.4
        )
        _text(canvas, text, (WIDTH_PX - 310, y), 0.55)


def _text(canvas: Image, text: str, at: tuple[int, int], scale: float) -> None:
    cv2.putText(canvas, text, at, cv2.FONT_HERSHEY_SIMPLEX, scale, INK, 1, cv2.LINE_AA)
