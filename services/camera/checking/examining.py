"""From what was watched to a report and a marked picture. Pure."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from services.camera.checking.coverage import coverage_of, ends, joins, jump
from services.camera.checking.flashing import delay_of
from services.camera.checking.level import Level, level_of
from services.camera.checking.marking import marked
from services.camera.checking.report import Mount, Report
from services.camera.checking.watching import Watched
from services.camera.frames import FrameMaker, decoded_picture, size_of
from services.camera.mount.calibration_file import FisheyeCalibration
from services.camera.mount.orientation import Orientation, levelled
from services.camera.mount.table import first_lens_sees
from services.camera.settings import CameraSettings
from services.camera.source import Picture
from shared.jpeg import BadPictureError

Image = npt.NDArray[np.uint8]


def examine(
    settings: CameraSettings, maker: FrameMaker, fisheye: FisheyeCalibration | None, watched: Watched
) -> tuple[Report, Image | None]:
    """What a camera delivers, and its last panorama with marks; None where no frame can be made.

    Args:
        settings: of the camera service.
        maker: makes frames by these.
        fisheye: the calibration that they name.
        watched: what came.
    """
    bad = Counter(watched.bad)
    frames = []
    for picture in watched.kept:
        try:
            frames.append((picture, maker.panorama(picture)))
        except BadPictureError as error:
            bad[str(error)] += 1
    report = Report(
        source=settings.camera.url.shown,
        live=settings.camera.kind.live,
        pictures=len(watched.arrivals_s),
        repeated=watched.repeated,
        bad=bad.total(),
        bad_why=bad.most_common(1)[0][0] if bad else "",
        ended=watched.ended,
        model=watched.facts.model,
        mode=watched.facts.mode,
        battery=watched.facts.battery_fraction,
        stamp_delay_s=settings.delay_s,
        stamp_is_usual=settings.delay_ms is None,
        flashed=bool(watched.parts),
        lenses=fisheye is not None,
        delay_s=delay_of(watched.changes, watched.arrivals_s, np.array(watched.parts)),
        clock_jump_s=_jump_s(watched.clock_s),
        rate_hz=rate_hz(watched.arrivals_s),
        longest_pause_s=max(np.diff(watched.arrivals_s), default=None),
    )
    if not frames:
        return report, None
    return _of_frames(report, settings, maker, fisheye, frames)


def _of_frames(
    report: Report,
    settings: CameraSettings,
    maker: FrameMaker,
    fisheye: FisheyeCalibration | None,
    frames: Sequence[tuple[Picture, Image]],
) -> tuple[Report, Image]:
    picture, panorama = frames[-1]
    same = [one for _, one in frames if one.shape == panorama.shape]
    level, coverage = level_of(panorama), coverage_of(same)
    frame = maker.frame(picture, seq=0)
    found = replace(
        report,
        width_px=frame.width_px,
        height_px=frame.height_px,
        passed_on=frame.data is picture.data,
        mount=mount_of(level, settings.orientation),
        seam=float(np.median([_seam(settings, fisheye, *one) for one in frames])),
        from_deg=math.degrees(coverage.lowest_rad),
        to_deg=math.degrees(coverage.highest_rad),
        blank=coverage.blank_share,
    )
    return found, marked(panorama, None if level is None else level.up)


def mount_of(level: Level | None, now: Orientation) -> Mount | None:
    """The mount that would be level: up in the frame is turned back to the camera's frame first."""
    if level is None:
        return None
    then = levelled(now.rotation.T @ level.up, now)
    turns = (math.degrees(one) for one in (level.lean_rad, level.std_rad, then.roll_rad, then.pitch_rad))
    return Mount(*turns)


def _seam(
    settings: CameraSettings, fisheye: FisheyeCalibration | None, picture: Picture, panorama: Image
) -> float:
    """Of one panorama as it came, or of two fisheyes as they are joined."""
    if fisheye is not None:
        return jump(panorama, joins(first_lens_sees(panorama.shape[1], fisheye, settings.orientation)))
    as_it_came = decoded_picture(picture, min(size_of(picture)[0], settings.width_px))
    return jump(as_it_came, ends(as_it_came))


def rate_hz(arrivals_s: Sequence[float]) -> float | None:
    """Pictures a second; None of a single one."""
    span_s = arrivals_s[-1] - arrivals_s[0] if len(arrivals_s) > 1 else 0.0
    return (len(arrivals_s) - 1) / span_s if span_s > 0.0 else None


def _jump_s(clock_s: Sequence[float]) -> float:
    """What the wall clock was set by, seconds: its largest step against the monotonic one."""
    steps = np.diff(clock_s)
    return float(steps[np.argmax(np.abs(steps))]) if len(steps) else 0.0
