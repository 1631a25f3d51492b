"""What the guard lets through: nothing that is old, nothing into what is near, no sudden starts. Pure.

Speed: a robot that brakes at b after a delay t comes to stand after v t + v^2 / (2 b). So that this is no
more than the free way d in its direction, v = sqrt((b t)^2 + 2 b d) - b t at most; t is the age of the scan
and one period of the loop.
"""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from services.ros.conversions.scan import PROFILE_BINS, FloatArray, Sectors
from services.ros.conversions.twist import STAND, Motion
from services.ros.robot_file import Guard
from shared.geometry.clearance import Obstacles
from shared.messages.base import SECTORS

NEVER_S = float("-inf")


def speed_limit_mps(free_m: float, brake_mps2: float, delay_s: float) -> float:
    """Fastest speed from which the robot stands within `free_m`."""
    if free_m <= 0.0:
        return 0.0
    if math.isinf(free_m):
        return math.inf
    late_mps = brake_mps2 * delay_s
    return math.sqrt(late_mps**2 + 2.0 * brake_mps2 * free_m) - late_mps


@dataclass(frozen=True)
class Verdict:
    """What the base is to do, and what was changed about the wish; "" for nothing.

    Attributes:
        kind: of the reason: "old" or "near".
    """

    motion: Motion
    why: str = ""
    kind: Literal["old", "near"] = "old"


class GuardCore:
    """Remembers the newest wish and scan, and what it said last. Times are monotonic seconds."""

    def __init__(self, limits: Guard, period_s: float) -> None:
        self._limits, self._period_s = limits, period_s
        self._wish, self._wish_s = STAND, NEVER_S
        self._near, self._scan_s = Obstacles(np.zeros((0, 2))), NEVER_S
        self._said, self._said_s = STAND, NEVER_S

    def hear(self, wish: Motion, came_s: float) -> None:
        """Take a velocity."""
        self._wish, self._wish_s = wish, came_s

    def see(self, sectors: Sectors, came_s: float) -> None:
        """Take a scan; where nothing was looked at something may stand as near as may be."""
        bearings_rad = np.arange(PROFILE_BINS) * math.tau / PROFILE_BINS
        distances_m = sectors.profile_m.copy()
        sector = np.round(bearings_rad * SECTORS / math.tau).astype(int) % SECTORS
        distances_m[np.isin(sector, sectors.blind)] = self._limits.stop_m
        seen = np.isfinite(distances_m)
        self._near = Obstacles(_points(bearings_rad[seen], distances_m[seen]))
        self._scan_s = came_s

    def verdict(self, now_s: float) -> Verdict:
        """What to tell the base now."""
        found = self._judge(now_s)
        self._said, self._said_s = found.motion, now_s
        return found

    def _judge(self, now_s: float) -> Verdict:
        wish_age_s, scan_age_s = now_s - self._wish_s, now_s - self._scan_s
        if wish_age_s > self._limits.command_ms / 1000.0:
            return Verdict(STAND, "" if self._said.stands else f"no velocity for {wish_age_s:.2f} s")
        if self._wish.stands:
            return Verdict(STAND)
        if scan_age_s > self._limits.scan_ms / 1000.0:
            return Verdict(STAND, f"no scan for {min(scan_age_s, 999.0):.2f} s")
        motion, why = self._in_free_way(self._wish, scan_age_s)
        return Verdict(self._without_a_start(motion, now_s), why, "near")

    def _in_free_way(self, wish: Motion, scan_age_s: float) -> tuple[Motion, str]:
        speed_mps = math.hypot(wish.forward_mps, wish.left_mps)
        if speed_mps == 0.0:
            return wish, ""
        direction = np.array([math.atan2(wish.left_mps, wish.forward_mps)])
        free_m = float(self._near.clearance_m(direction, self._limits.stop_m)[0])
        most_mps = speed_limit_mps(free_m, self._limits.brake_mps2, scan_age_s + self._period_s)
        if speed_mps <= most_mps:
            return wish, ""
        return wish.scaled(most_mps / speed_mps), f"{free_m:.2f} m are free: {most_mps:.2f} m/s"

    def _without_a_start(self, motion: Motion, now_s: float) -> Motion:
        """Speeding up is limited, from rest also into another direction; slowing down is not."""
        limits, said = self._limits, self._said
        time_s = min(max(now_s - self._said_s, 0.0), self._period_s)
        speed_mps = math.hypot(motion.forward_mps, motion.left_mps)
        if speed_mps > 0.0:
            along = said.forward_mps * motion.forward_mps + said.left_mps * motion.left_mps
            most_mps = max(0.0, along / speed_mps) + limits.accelerate_mps2 * time_s
            motion = motion.scaled(min(1.0, most_mps / speed_mps))
        before_radps = max(0.0, said.turn_radps * math.copysign(1.0, motion.turn_radps))
        most_radps = before_radps + limits.turn_radps2 * time_s
        return replace(motion, turn_radps=max(-most_radps, min(most_radps, motion.turn_radps)))


def _points(bearings_rad: FloatArray, distances_m: FloatArray) -> FloatArray:
    return np.stack([distances_m * np.cos(bearings_rad), distances_m * np.sin(bearings_rad)], axis=-1)
