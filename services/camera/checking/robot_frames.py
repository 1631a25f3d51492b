"""The same look at frames of a robot's bus, whoever made them: `topnav robot check`. Pure."""

import math
from collections.abc import Sequence
from itertools import pairwise

import cv2
import numpy as np
import numpy.typing as npt

from services.camera.checking.coverage import coverage_of, ends, jump
from services.camera.checking.level import level_of
from services.camera.checking.marking import marked
from services.camera.checking.report import Mount, Report
from shared.messages.sensors import Frame

Image = npt.NDArray[np.uint8]


def look_at(frames: Sequence[Frame], arrivals_s: Sequence[float], source: str) -> tuple[Report, bytes]:
    """What the frames are like, and the last one with horizon and directions marked, as PNG.

    Args:
        frames: some of those that came, at least one.
        arrivals_s: when all came, monotonic; at least as many.
        source: what is said to have made them.
    """
    panoramas = [_panorama(frame) for frame in frames]
    same = [one for one in panoramas if one.shape == panoramas[-1].shape]
    level, coverage = level_of(same[-1]), coverage_of(same)
    gaps_s = np.diff(arrivals_s)
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
        rate_hz=float(len(gaps_s) / gaps_s.sum()) if len(gaps_s) else None,
        longest_pause_s=float(gaps_s.max()) if len(gaps_s) else None,
        mount=None if level is None else _mount(level.up, level.lean_rad, level.std_rad),
        seam=float(np.median([jump(one, ends(one)) for one in same])),
        from_deg=math.degrees(coverage.lowest_rad),
        to_deg=math.degrees(coverage.highest_rad),
        blank=coverage.blank_share,
    )
    picture = marked(same[-1], None if level is None else level.up)
    return report, cv2.imencode(".png", picture)[1].tobytes()


def _mount(up: npt.NDArray[np.float64], lean_rad: float, std_rad: float) -> Mount:
    """Roll and pitch by which the camera's own settings would have to change."""
    roll_rad, pitch_rad = math.atan2(up[1], up[2]), math.atan2(-up[0], math.hypot(up[1], up[2]))
    return Mount(*(math.degrees(one) for one in (lean_rad, std_rad, roll_rad, pitch_rad)))


def _panorama(frame: Frame) -> Image:
    data = np.frombuffer(frame.data, np.uint8)
    if frame.encoding == "jpeg":
        return np.asarray(cv2.imdecode(data, cv2.IMREAD_COLOR), dtype=np.uint8)
    return data.reshape(frame.height_px, frame.width_px, 3)
