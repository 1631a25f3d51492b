"""What a camera delivers, in plain words, and what is wrong with it. Pure."""

import math
from dataclasses import asdict, dataclass
from typing import Any

SLOWEST_HZ = 3.0
"""A robot stands between pictures that come more rarely: a heading lives 0.35 s (PLANNER_HEADING_TTL_MS)."""
LONGEST_PAUSE_S = 1.0
"""Chosen: three headings in a row are missed."""
MOST_BAD = 0.05
"""Share of pictures that cannot be used; chosen: one in twenty costs a heading now and then."""
MOST_REPEATED = 5.0
"""Times as many as new ones; chosen: a stream at 30 Hz of a camera at 5."""
CLOCK_JUMP_S = 0.1
"""Chosen: what a stamp may be off by before the robot's motion since then is the wrong one."""
MOST_DELAY_OFF_S = 0.1
"""Chosen, likewise: half a metre a second makes 5 cm of it."""
MOST_LEAN_DEG = 2.0
"""Chosen: a little more than photographers' tripods lean by (decision 0031)."""
SURE = 3.0
"""Standard deviations beyond which a lean is one."""
MOST_JUMP = 3.0
"""Times as much change across a seam as beside it; chosen: what is near breaks at a seam by about two."""
MOST_BLANK = 0.02
"""Share of what features need that may be black; chosen: a bracket and a cable."""


@dataclass(frozen=True)
class Mount:
    """The settings that make pictures level, degrees, and what they are off by now."""

    lean_deg: float
    std_deg: float
    roll_deg: float
    pitch_deg: float


@dataclass(frozen=True)
class Report:
    """What was found; None of what cannot be told.

    Attributes:
        source: the camera's URL without its password; model, mode and battery as it says them.
        pictures: new ones that came; repeated: the one before again; bad: that cannot be used, and why most.
        ended: why it ended early.
        width_px, height_px: of the frames made of them.
        passed_on: frames are the camera's own JPEGs.
        rate_hz: new pictures a second; longest_pause_s between two of them.
        clock_jump_s: what this machine's clock was set by meanwhile.
        stamp_delay_s: how far back frames are stamped; stamp_is_usual: nobody measured it.
        delay_s: as measured by a screen; flashed: whether that was asked for.
        mount: how level it is.
        seam: how many times as much the picture changes across its seam as beside it.
        lenses: the seam is that of two lenses.
        from_deg, to_deg: latitudes that are seen; blank: share of what features need that is black.
    """

    source: str
    live: bool
    pictures: int
    repeated: int
    bad: int
    stamp_delay_s: float
    stamp_is_usual: bool
    flashed: bool
    lenses: bool
    bad_why: str = ""
    ended: str = ""
    model: str = ""
    mode: str = ""
    battery: float | None = None
    width_px: int = 0
    height_px: int = 0
    passed_on: bool = False
    rate_hz: float | None = None
    longest_pause_s: float | None = None
    clock_jump_s: float = 0.0
    delay_s: float | None = None
    mount: Mount | None = None
    seam: float | None = None
    from_deg: float | None = None
    to_deg: float | None = None
    blank: float | None = None

    def figures(self) -> dict[str, Any]:
        """All of it and what is wrong, for JSON."""
        told = {k: round(v, 4) if isinstance(v, float) else v for k, v in asdict(self).items()}
        told["mount"] = self.mount and {k: round(v, 3) for k, v in asdict(self.mount).items()}
        return {**told, "problems": problems(self)}


def lines(report: Report) -> list[tuple[str, str]]:
    """What the camera delivers: a word each, and what is so."""
    facts = [report.model, f"mode {report.mode}" if report.mode else ""]
    facts += [] if report.battery is None else [f"battery {100.0 * report.battery:.0f} %"]
    told = [("camera", ", ".join(filter(None, [report.source, *facts])))]
    if report.rate_hz is not None and report.longest_pause_s is not None:
        pause = f"the longest pause is {report.longest_pause_s:.2f} s"
        told.append(("rate", f"{report.rate_hz:.1f} pictures a second, {pause}"))
    if report.width_px:
        how = "the camera's own JPEGs" if report.passed_on else "made of the camera's pictures"
        told.append(("frames", f"{report.width_px} x {report.height_px}, {how}"))
    told.append(("stamp", _stamp(report)))
    if not report.pictures or not report.width_px:
        return told
    told.append(("level", _level(report.mount)))
    if report.seam is not None:
        what = "where the two lenses meet" if report.lenses else "where left and right edge meet"
        told.append(("seam", f"{what} the picture changes {report.seam:.1f} times as much as beside it"))
    if report.from_deg is not None and report.to_deg is not None:
        above = f"{-report.from_deg:.0f} degrees below the horizon to {report.to_deg:.0f} above"
        told.append(("coverage", "the whole sphere" if _is_whole(report) else above))
    return told


def problems(report: Report) -> list[str]:
    """What is wrong, a sentence each, and what to do."""
    if not report.pictures:
        why = report.ended or report.bad_why or "none came"
        return [f"no picture that can be used: {why}"]
    found = [*_in_time(report), *_of_stamps(report)]
    if not report.width_px:
        return [f"no frame can be made of its pictures: {report.bad_why}", *found]
    mount = report.mount
    if mount is not None and mount.lean_deg > max(MOST_LEAN_DEG, SURE * mount.std_deg):
        found.append(
            f"frames lean by {mount.lean_deg:.1f} degrees: set CAMERA_ROLL_DEG={mount.roll_deg:.1f} and "
            f"CAMERA_PITCH_DEG={mount.pitch_deg:.1f}, or put the camera level"
        )
    if report.seam is not None and report.seam > MOST_JUMP:
        found.append(_broken(report))
    if report.blank is not None and report.blank > MOST_BLANK:
        found.append(
            f"{100.0 * report.blank:.0f} % of what is within 55 degrees of the horizon is black: "
            "choose the camera's 360-degree output"
        )
    return found


def _in_time(report: Report) -> list[str]:
    found = []
    everything = report.pictures + report.bad
    if report.bad > MOST_BAD * everything:
        found.append(f"{report.bad} of {everything} pictures cannot be used, most: {report.bad_why}")
    if report.repeated > MOST_REPEATED * report.pictures:
        of = f"{report.repeated} of {report.repeated + report.pictures} pictures"
        found.append(f"{of} are the one before, bit by bit: it hangs, or sends the same again and again")
    if report.ended and report.live:
        found.append(f"it broke off: {report.ended}")
    if report.live and report.rate_hz is not None and report.rate_hz < SLOWEST_HZ:
        found.append(
            f"{report.rate_hz:.1f} pictures a second: the robot stands between them; {SLOWEST_HZ:.0f} or more"
        )
    elif report.live and report.longest_pause_s is not None and report.longest_pause_s > LONGEST_PAUSE_S:
        found.append(f"no picture for {report.longest_pause_s:.1f} s meanwhile: the robot stands then")
    return found


def _of_stamps(report: Report) -> list[str]:
    found = []
    if abs(report.clock_jump_s) > CLOCK_JUMP_S:
        jump = f"{report.clock_jump_s:+.1f} s"
        found.append(f"this machine's clock was set by {jump}: frames stamped then are refused, chrony")
    if report.flashed and report.delay_s is None:
        found.append("no screen seen that turns bright and dark: put this one before the camera, nearer")
    elif report.delay_s is not None and abs(report.delay_s - report.stamp_delay_s) > MOST_DELAY_OFF_S:
        found.append(
            f"pictures come {1e3 * report.delay_s:.0f} ms after their exposure, but are stamped "
            f"{1e3 * report.stamp_delay_s:.0f} ms back: set CAMERA_DELAY_MS={1e3 * report.delay_s:.0f}"
        )
    return found


def _stamp(report: Report) -> str:
    back = f"frames are stamped {1e3 * report.stamp_delay_s:.0f} ms before they come"
    if report.delay_s is not None:
        return f"{back}; measured: {1e3 * report.delay_s:.0f} ms from exposure to arrival"
    if not report.stamp_is_usual:
        return f"{back}, as CAMERA_DELAY_MS says"
    return f"{back}, which is usual for such a camera" + (": --flash measures it" if report.live else "")


def _level(mount: Mount | None) -> str:
    if mount is None:
        return "not told: too few upright edges in sight; look at the picture"
    return f"leans by {mount.lean_deg:.1f} degrees (give or take {mount.std_deg:.1f})"


def _broken(report: Report) -> str:
    if report.lenses:
        return (
            f"the two fisheyes do not fit at their seam ({report.seam:.1f}): calibrate this camera "
            "(topnav camera calibrate), or it stands too near to something"
        )
    return (
        f"left and right edge of the picture do not meet ({report.seam:.1f}): it is no whole turn; "
        "choose the camera's 360-degree output, stitched"
    )


def _is_whole(report: Report) -> bool:
    ends = report.from_deg, report.to_deg
    return all(end is not None and math.isclose(abs(end), 90.0, abs_tol=1.0) for end in ends)
