"""The same look at frames of a robot's bus, whoever made them: `topnav robot check`. Pure."""

import math
from collections.abc import Sequence
from itertools import pairwise

import cv2
import numpy as np
import numpy.typing as npt

from services.camera.checking.coverage import coverage_of, ends, jump
from services.camera.checking.examining import mount_of, rate_hz
from services.camera.checking.level import level_of
from services.camera.checking.marking import marked
from services.camera.checking.report import Report
from services.camera.frames import decoded_picture
from services.camera.mount.orientation import Orientation
from services.camera.source import Picture
from shared.messages.sensors import Frame

Image = npt.NDArray[np.uint8]


def look_at(frames: Sequence[Frame], arrivals_s: Sequence[float], source: str) -> tuple[Report, bytes]:
    """What the frames are like, and the last one with horizon and directions marked, as PNG.

    Args:
        frames: some of those that came, at least one.
        arrivals_s: when all came, monotonic; at least as many.
        source: what is said to have made them.

    Raises:
        BadPictureError: a damaged one.
    """
    panoramas = [_panorama(frame) for frame in frames]
    same = [one for one in panoramas if one.shape == panoramas[-1].shape]
    level, coverage = level_of(same[-1]), coverage_of(same)
    report = Report(
        source=source,
        live=True,
        pictures=len(arrivals_s),
        repeated=sum(a.data == b.data for a, b in pairwise(frames)),
        bad=0,
        stamp_delay_s=0.0,
        stamp_is_usual=False,
        flashed=False,
        lenses=False,
        width_px=frames[-1].width_px,
        height_px=frames[-1].height_px,
        rate_hz=rate_hz(arrivals_s),
        longest_pause_s=max(np.diff(arrivals_s), default=None),
        mount=mount_of(level, Orientation()),
        seam=float(np.median([jump(one, ends(one)) for one in same])),
        from_deg=math.degrees(coverage.lowest_rad),
        to_deg=math.degrees(coverage.highest_rad),
        blank=coverage.blank_share,
    )
    picture = marked(same[-1], None if level is None else level.up)
    return report, cv2.imencode(".png", picture)[1].tobytes()


def _panorama(frame: Frame) -> Image:
    if frame.encoding == "jpeg":
        return decoded_picture(Picture(frame.data, frame.stamp_ns), frame.width_px)
    return np.frombuffer(frame.data, np.uint8).reshape(frame.height_px, frame.width_px, 3)
