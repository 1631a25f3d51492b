"""Signs in a panorama: read in tangent views all round, again larger, and again in another frame. Pure.

A reading counts where it is confident, whole, and the same in three pictures: a view of the node's frame, a
larger one around it, and one of a frame taken beside the node.
"""

import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

import cv2
import numpy as np

from services.signs.recognition import Image, Line
from shared.geometry.perspective import PerspectiveView, view_table
from shared.geometry.sphere import EquirectGrid, angle_between_rad, lonlat_from_bearings
from shared.mapgraph.signs import clean
from shared.messages.places import key_of

Read = Callable[[Image], list[Line]]

VIEWS = 6
FOV_RAD = math.radians(80.0)
"""Of each view: they overlap by 20 degrees, a plate of 0.3 m at 0.9 m."""
LATITUDE_RAD = math.radians(22.0)
"""Of their centres: signs hang above the camera; a view reaches from 10 degrees below the
horizon to 54 above, where a plate is that one passes at 0.6 m."""
WIDTH_SHARE = 0.44
"""Of a view over the panorama: 1.6 times its resolution, with which text of 12 rows is found."""
WIDTHS_PX = (320, 640)
LARGE_FOV_RAD = math.radians(50.0)
"""Of the second look: a step of 0.3 m between two frames leaves a sign 1 m away inside."""
BORDER_PX = 4
"""A text nearer to the border may go on beyond it."""
SAME_RAD = 0.12
"""Two readings nearer to each other are of one thing: half the width of a plate at 1.2 m."""
LEAST_LETTERS = 2
"""One letter is read into any pattern."""


@dataclass(frozen=True)
class Reading:
    """A line of text in a panorama.

    Attributes:
        text: cleaned.
        bearing: (3,) unit vector to its middle, camera frame.
        height_rad: how high the line appears.
    """

    text: str
    confidence: float
    bearing: tuple[float, float, float]
    height_rad: float

    @property
    def longitude_rad(self) -> float:
        """Counter-clockwise from ahead."""
        return float(lonlat_from_bearings(self.bearing)[0])


def signs_in(frame: Image, beside: Image, read: Read, least_confidence: float) -> list[Reading]:
    """What can be read for sure in a panorama.

    Args:
        frame: (height, 2 height, 3) BGR.
        beside: another one, taken within a step of it.
        read: finds lines of text in a picture.
        least_confidence: of a reading that counts.
    """
    first = unequivocal(
        one for view in views(frame.shape[1]) for one in readings(frame, view, read, least_confidence)
    )
    found = []
    for one in first:
        view = view_at(one, frame.shape[1])
        again = _same(one, readings(frame, view, read, least_confidence))
        if again is not None and _same(one, readings(beside, view, read, least_confidence)) is not None:
            found.append(again)
    return unequivocal(found)


def views(panorama_px: int) -> list[PerspectiveView]:
    """Tangent views all round, for a panorama so wide."""
    width = int(np.clip(round(WIDTH_SHARE * panorama_px), *WIDTHS_PX))
    steps = (2.0 * math.pi * k / VIEWS - math.pi for k in range(VIEWS))
    return [PerspectiveView(width, width * 3 // 4, FOV_RAD, step, LATITUDE_RAD) for step in steps]


def view_at(one: Reading, panorama_px: int) -> PerspectiveView:
    """A larger picture with a reading in its middle."""
    width = int(np.clip(round(WIDTH_SHARE * panorama_px), *WIDTHS_PX))
    lon, lat = lonlat_from_bearings(one.bearing).tolist()
    return PerspectiveView(width, width * 3 // 4, LARGE_FOV_RAD, lon, lat)


def readings(
    panorama: Image, view: PerspectiveView, read: Read, least_confidence: float
) -> Iterator[Reading]:
    """Confident lines that lie inside a view."""
    height, width = panorama.shape[:2]
    table = view_table(view, EquirectGrid.cropped(width, height, 0.0))
    cut = cv2.remap(panorama, table.map_x, table.map_y, cv2.INTER_CUBIC, borderMode=cv2.BORDER_WRAP)
    for line in read(np.asarray(cut, np.uint8)):
        text = clean(line.text)
        inside = line.corners.min() >= BORDER_PX and bool(
            (line.corners <= (view.width - BORDER_PX, view.height - BORDER_PX)).all()
        )
        if inside and line.confidence >= least_confidence and sum(map(str.isalnum, text)) >= LEAST_LETTERS:
            yield _reading(text, line, view)


def unequivocal(found: Iterable[Reading]) -> list[Reading]:
    """One reading of each thing, the most confident; none of what is read in two ways."""
    kept: list[Reading] = []
    doubtful: list[Reading] = []
    for one in sorted(found, key=lambda reading: -reading.confidence):
        others = [other for other in kept if _apart_rad(one, other) < SAME_RAD]
        if not others:
            kept.append(one)
        elif any(key_of(other.text) != key_of(one.text) for other in others):
            doubtful += [one, *others]
    return [one for one in kept if one not in doubtful]


def _same(one: Reading, others: Iterable[Reading]) -> Reading | None:
    """The reading that says the same; None where there is none, or several: which is meant is not known."""
    same = [other for other in others if key_of(other.text) == key_of(one.text)]
    return same[0] if len(same) == 1 else None


def _reading(text: str, line: Line, view: PerspectiveView) -> Reading:
    corners = view.bearings_from_pixels(line.corners)
    top, low = corners[0] + corners[1], corners[2] + corners[3]
    middle = corners.sum(axis=0) / np.linalg.norm(corners.sum(axis=0))
    x, y, z = middle.tolist()
    return Reading(text, line.confidence, (x, y, z), float(angle_between_rad(top, low)))


def _apart_rad(one: Reading, other: Reading) -> float:
    return float(angle_between_rad(np.array(one.bearing), np.array(other.bearing)))
