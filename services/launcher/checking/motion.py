"""Whether the robot moves as it is told, seen by its own camera. Pure.

Between two pictures two-view geometry says in which direction the camera went and how it turned. That must be
what the wheels were told; where it is not, the way in which it differs says what is wrong.
"""

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from shared.geometry.sphere import bearings_from_lonlat, wrap_rad
from shared.messages.matching import NodeMatch

STEP_M, TURN_RAD = 0.2, math.radians(30.0)
SURE = 0.3
"""Least confidence of a direction that is taken for one; chosen."""
MOST_OFF_RAD = math.radians(20.0)
"""Of a direction; chosen: what confidence speaks of (NodeMatch)."""
MOST_TURNED_RAD = math.radians(8.0)
"""The picture's middle may be this far from straight ahead; chosen: twice what such a short way tells."""
TURN_SHARE = 0.35
"""By which a turn may differ from what was told; chosen: wheels slip on carpet."""
WAY_SHARE = 0.35
"""By which odometry may differ likewise."""
LEAST_TOLD = 0.5
"""Of a move, less is none: something near kept drive from it; chosen."""
UPSIDE_DOWN_SHARE = 0.8
"""The floor is nearer than the ceiling, so what is below the horizon moves more: this much less is above."""


@dataclass(frozen=True)
class Move:
    """What is told: metres along the robot's axes, or a turn, counter-clockwise."""

    name: str
    forward_m: float = 0.0
    left_m: float = 0.0
    turn_rad: float = 0.0

    @property
    def direction_rad(self) -> float:
        """Where to, robot frame."""
        return math.atan2(self.left_m, self.forward_m)


MOVES = (
    Move("ahead", forward_m=STEP_M),
    Move("back", forward_m=-STEP_M),
    Move("left", left_m=STEP_M),
    Move("right", left_m=-STEP_M),
    Move("turn left", turn_rad=TURN_RAD),
    Move("turn right", turn_rad=-TURN_RAD),
)
"""In this order it ends where it began."""


@dataclass(frozen=True)
class Seen:
    """What came of a move.

    Attributes:
        told_share: of the move that drive passed on to the base; less than 1 before obstacles.
        match: the picture before it against the one after it.
        odometry: metres ahead, metres to the left and turn of the wheels meanwhile, frame before the move;
            None without odometry.
        answer_s: from the first word to the wheels' motion by odometry; None without.
    """

    move: Move
    told_share: float
    match: NodeMatch
    odometry: tuple[float, float, float] | None = None
    answer_s: float | None = None

    @property
    def heading_rad(self) -> float | None:
        """Where the camera says it went, camera frame; None if it cannot tell."""
        return self.match.heading_rad if self.match.confidence >= SURE else None

    @property
    def still(self) -> bool:
        """Whether both pictures show the same from the same place."""
        turned = abs(self.match.yaw_rad or 0.0) > 0.25 * TURN_RAD
        return self.match.status == "no_baseline" and not turned


def falls_short(one: Seen) -> bool:
    """Whether the wheels went as drive told them and not far enough: something may have interrupted them."""
    if one.odometry is None or one.told_share < LEAST_TOLD or not _of_odometry([one]):
        return False
    told = (one.move.forward_m, one.move.left_m, one.move.turn_rad)
    done = sum(a * b for a, b in zip(one.odometry, told, strict=True)) / sum(b * b for b in told)
    return 0.0 <= done < one.told_share


def motion_problems(seen: Sequence[Seen]) -> list[str]:
    """What is wrong, a sentence each; each cause once."""
    done = [one for one in seen if one.told_share >= LEAST_TOLD]
    found = [
        f"told to go {one.move.name}, the camera sees no motion: do the wheels turn, do pictures come anew?"
        for one in done
        if one.still
    ]
    ways = [one for one in done if not one.move.turn_rad and one.heading_rad is not None]
    turns = [one for one in done if one.move.turn_rad and one.match.yaw_rad is not None and not one.still]
    swapped = bool(turns) and all((one.match.yaw_rad or 0.0) * one.move.turn_rad < 0.0 for one in turns)
    return [*found, *_of_directions(ways, swapped), *_of_turns(turns, swapped), *_of_odometry(done)]


def _of_directions(ways: Sequence[Seen], swapped: bool) -> list[str]:
    if not ways:
        return []
    offset_rad, spread_rad = _fit(ways, lambda one: _heading(one) - one.move.direction_rad)
    _, mirrored_rad = _fit(ways, lambda one: _heading(one) + one.move.direction_rad)
    if swapped and mirrored_rad < MOST_OFF_RAD:
        return [_swapped(ways)]
    if spread_rad < MOST_OFF_RAD:
        if abs(offset_rad) < MOST_TURNED_RAD:
            return []
        off_deg = math.degrees(-offset_rad)
        return [
            f"the picture's middle is {abs(off_deg):.0f} degrees to the {'left' if off_deg > 0 else 'right'} "
            f"of straight ahead: add {off_deg:+.0f} to CAMERA_HEADING_DEG, or to camera.ahead_deg of the "
            "robot's file"
        ]
    sideways = [one for one in ways if one.move.left_m]
    if sideways and mirrored_rad < MOST_OFF_RAD:
        return [
            "told to go left it goes right, and the other way round: the base's sideways axis is reversed"
        ]
    return [
        f"told to go {one.move.name} ({math.degrees(one.move.direction_rad):.0f} degrees), the camera sees "
        f"{math.degrees(_heading(one)):.0f}: is an axis of the base reversed, or a wheel loose?"
        for one in ways
        if abs(wrap_rad(_heading(one) - one.move.direction_rad)) > MOST_OFF_RAD
    ]


def _swapped(ways: Sequence[Seen]) -> str:
    """Left and right are swapped, by a mirror or by a roll of half a turn: the floor tells the two apart."""
    ratios = [ratio for one in ways if (ratio := below_above(one.match)) is not None]
    if ratios and float(np.median(ratios)) < UPSIDE_DOWN_SHARE:
        return "the camera hangs upside down: CAMERA_ROLL_DEG=180, or turn it over"
    return (
        "left and right are swapped in the picture: it is mirrored (CAMERA_MIRRORED=true, or the camera's "
        "own setting), or the camera hangs upside down (CAMERA_ROLL_DEG=180)"
    )


def _of_turns(turns: Sequence[Seen], swapped: bool) -> list[str]:
    if swapped:
        return [
            "told to turn left, the camera sees a turn to the right: unless the picture is to blame (above), "
            "the wheels are wired the wrong way round"
        ]
    found = []
    for one in turns:
        told_rad, seen_rad = one.move.turn_rad * one.told_share, one.match.yaw_rad or 0.0
        if abs(seen_rad - told_rad) > TURN_SHARE * abs(told_rad):
            found.append(
                f"told to {one.move.name} by {abs(math.degrees(told_rad)):.0f} degrees, the camera sees "
                f"{abs(math.degrees(seen_rad)):.0f}: the base's track or wheel size is wrong, or it slips"
            )
    return found


def _of_odometry(done: Sequence[Seen]) -> list[str]:
    found = []
    for one in done:
        if one.odometry is None:
            continue
        ahead_m, left_m, turn_rad = one.odometry
        share, move = one.told_share, one.move
        if move.turn_rad:
            if abs(turn_rad - share * move.turn_rad) > TURN_SHARE * abs(move.turn_rad):
                found.append(
                    f"told to {move.name} by {math.degrees(share * abs(move.turn_rad)):.0f} degrees, "
                    f"odometry says {math.degrees(turn_rad):+.0f} (left is positive)"
                )
        elif math.hypot(ahead_m - share * move.forward_m, left_m - share * move.left_m) > WAY_SHARE * STEP_M:
            found.append(
                f"told to go {move.name} by {share * STEP_M:.2f} m, odometry says {ahead_m:+.2f} m ahead and "
                f"{left_m:+.2f} m to the left"
            )
    return found


def _heading(one: Seen) -> float:
    assert one.heading_rad is not None
    return one.heading_rad


def _fit(ways: Sequence[Seen], angle: Callable[[Seen], float]) -> tuple[float, float]:
    """Mean of an angle, and the largest deviation from it."""
    angles = [angle(one) for one in ways]
    mean_rad = cmath.phase(sum(cmath.exp(1j * one) for one in angles))
    return mean_rad, max(abs(float(wrap_rad(one - mean_rad))) for one in angles)


def below_above(match: NodeMatch) -> float | None:
    """How much more what is below the horizon moved than what is above it; None where too little was seen."""
    if match.matches_rad is None or match.inlier_mask is None or match.yaw_rad is None:
        return None
    rows = np.asarray(match.matches_rad, dtype=np.float64)[np.asarray(match.inlier_mask, dtype=bool)]
    before, after = rows[:, :2], rows[:, 2:] + [match.yaw_rad, 0.0]
    moved = np.arccos(
        np.clip(np.sum(bearings_from_lonlat(before) * bearings_from_lonlat(after), axis=1), -1, 1)
    )
    below = before[:, 1] < 0.0
    if min(below.sum(), (~below).sum()) < 8:
        return None
    return float(np.median(moved[below]) / max(float(np.median(moved[~below])), 1e-6))
