"""What is there now and was not, or was and is not, as regions of the current picture. Pure."""

import math
from dataclasses import dataclass

import numpy as np

from services.features.changes.regions import regions
from services.features.changes.search import Map, unexplained
from services.features.changes.signature import WIDTH_PX, signature
from services.features.pipeline.interfaces import Image
from shared.messages.inspections import Region

BAND_RAD = math.radians(45.0)
"""Compared above and below the horizon: further down the robot sees itself, further up is ceiling."""
LEAST_REACH_RAD, MOST_REACH_RAD = math.radians(3.0), math.radians(25.0)
"""Of the search; chosen: the turn is known to a degree; from 0.3 m away, things at 0.7 m shift by 25."""
REACH_PER_DISPARITY = 4.5
"""Things at half a metre shift so much more than the keypoints' median, 2.5 m away indoors."""


@dataclass(frozen=True)
class Sensitivity:
    """When a difference is reported; the defaults are those of `topnav study changes`.

    Attributes:
        share: of a patch that the other picture shows nowhere near, 0 to 1.
        size_sr: solid angle of a region, steradians.
        either: weight of what only one of both pictures has and the other may show elsewhere: a plain wall
            behind a thing that was taken away is found beside it. 0 asks for both, 1 for any.
    """

    share: float = 0.18
    size_sr: float = 0.004
    either: float = 0.5


def changed_regions(
    reference: Image,
    current: Image,
    yaw_rad: float,
    disparity_rad: float = 0.0,
    sensitivity: Sensitivity | None = None,
) -> list[Region]:
    """Where the current picture of a place differs from an earlier one, most significant first.

    Args:
        reference: (H, 2 H, 3) BGR, equirectangular, camera upright.
        current: the same from a spot up to 0.3 m away; it may have another size.
        yaw_rad: turn from the reference's camera to the current one, counter-clockwise.
        disparity_rad: by how much bearings of what both show differ beside the turn.
        sensitivity: when a difference counts.

    Returns:
        Regions in the frame of the current camera.
    """
    wanted = sensitivity or Sensitivity()
    found = differences(reference, current, yaw_rad, disparity_rad)
    return regions(found.map(wanted.either), found.first_row, wanted.share, wanted.size_sr)


@dataclass(frozen=True, eq=False)
class Differences:
    """Shares that are unexplained, of a band of the current picture at WIDTH_PX columns.

    Attributes:
        of_reference, of_current: (rows, WIDTH_PX), see `search.unexplained`.
        first_row: of the band.
    """

    of_reference: Map
    of_current: Map
    first_row: int

    def map(self, either: float) -> Map:
        """Both in one, see `Sensitivity`."""
        both = np.minimum(self.of_reference, self.of_current)
        return np.asarray(np.maximum(both, either * np.maximum(self.of_reference, self.of_current)))


def differences(reference: Image, current: Image, yaw_rad: float, disparity_rad: float) -> Differences:
    """Search either picture for what the other shows; arguments as those of `changed_regions`."""
    before, now = signature(reference), signature(current)
    before = np.roll(before, round(yaw_rad / math.tau * WIDTH_PX), axis=1)
    reach_rad = REACH_PER_DISPARITY * disparity_rad + LEAST_REACH_RAD
    reach_px = math.ceil(min(reach_rad, MOST_REACH_RAD) / math.tau * WIDTH_PX)
    band_px = round(BAND_RAD / math.tau * WIDTH_PX)
    rows = slice(WIDTH_PX // 4 - band_px, WIDTH_PX // 4 + band_px)
    return Differences(*unexplained(before, now, rows, reach_px), rows.start)
