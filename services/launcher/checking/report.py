"""What a check of a robot found, as lines for people and as JSON. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from services.launcher.checking.motion import LEAST_TOLD, Seen, below_above
from shared.messages.sensors import Ranges

STALE_S = 0.6
"""A picture older than this when it comes makes a slow robot (study latency)."""
STOP_S = 0.5
"""From the last word to standing; what every stop of topnav keeps to (deploy/FAULTS.md)."""
ANSWER_S = 0.5
"""From a wish to turning wheels; chosen: more feels like a robot that does not obey."""


@dataclass(frozen=True)
class Stops:
    """How soon it stood; None where nothing says when, or where it was not tried.

    Attributes:
        let_go_s: after a hand that let go.
        estop_s: after the emergency stop; obeyed: whether it stayed where it was under it, told to move.
    """

    let_go_s: float | None = None
    estop_s: float | None = None
    obeyed: bool = True


def delay_problems(ages_s: Sequence[float]) -> list[str]:
    """What is wrong with the age of pictures when they come, by their stamps."""
    if not ages_s:
        return []
    oldest, newest = max(ages_s), min(ages_s)
    if newest < -0.05:
        return [f"pictures are stamped {-newest:.2f} s in the future: set the clocks by chrony"]
    if oldest > STALE_S:
        return [
            f"pictures are up to {oldest:.2f} s old when they come: a robot drives slowly with such a camera"
        ]
    return []


def stop_problems(stops: Stops) -> list[str]:
    """What is wrong with how it stops."""
    found = []
    for after_s, what in ((stops.let_go_s, "let go"), (stops.estop_s, "stopped by the emergency stop")):
        if after_s is not None and after_s > STOP_S:
            found.append(f"{what}, it stood after {after_s:.2f} s: {STOP_S} at most; do not let it drive")
    if not stops.obeyed:
        found.append("told to move under the emergency stop, it moved: do not let it drive")
    return found


def move_line(one: Seen) -> tuple[str, str]:
    """What the camera saw of a move."""
    return "move", f"{one.move.name}: {_told(one)}"


def _told(one: Seen) -> str:
    if one.told_share < LEAST_TOLD:
        return "not made: the base cannot, or something is near"
    turned = "" if one.match.yaw_rad is None else f", turned {math.degrees(one.match.yaw_rad):+.0f}"
    went = "cannot tell where to" if one.heading_rad is None else f"went {math.degrees(one.heading_rad):+.0f}"
    wheels = ""
    if one.odometry is not None:
        ahead_m, left_m, turn_rad = one.odometry
        wheels = f"; wheels: {ahead_m:+.2f} m, {left_m:+.2f} m, {math.degrees(turn_rad):+.0f}"
    return f"the camera {'stood' if one.still else went}{turned}{wheels}"


def ranges_line(ranges: Sequence[Ranges], seconds: float) -> tuple[str, str]:
    """Twelve distances, from straight ahead counter-clockwise; at least one reading of them."""
    shown = " ".join(f"{one:.1f}" for one in ranges[-1].distances_m)
    rate = f"{len(ranges) / seconds:.0f} a second, up to {ranges[-1].max_range_m:g} m"
    return "distances", f"{rate}: {shown} (ahead first, then to the left)"


def move_figures(one: Seen) -> dict[str, Any]:
    """A move for JSON."""
    figures: dict[str, Any] = {
        "move": one.move.name, "told_share": round(one.told_share, 3), "status": one.match.status,
        "heading_deg": _degrees(one.match.heading_rad), "yaw_deg": _degrees(one.match.yaw_rad),
        "confidence": round(one.match.confidence, 3), "odometry": one.odometry,
        "answer_s": one.answer_s, "below_above": below_above(one.match),
    }  # fmt: skip
    return figures


def _degrees(angle_rad: float | None) -> float | None:
    return None if angle_rad is None else round(math.degrees(angle_rad), 1)
