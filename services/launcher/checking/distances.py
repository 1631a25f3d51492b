"""Whether the twelve distances are where they say they are, by a box that a person puts down. Pure."""

import math
from collections.abc import Sequence

import numpy as np

from shared.messages.base import SECTORS

NEARER_M = 0.15
"""A box makes at least one distance so much shorter; chosen: ten times a sensor's noise."""
AHEAD, LEFT = 0, SECTORS // 4
DEG_PER_SECTOR = 360 // SECTORS
SILENT_SHARE = 0.75
"""Of the sectors; so many without anything in range are no room: chosen."""


def nearer_sector(before_m: Sequence[float], after_m: Sequence[float]) -> int | None:
    """Which distance became shorter most; None where none did."""
    change_m = np.asarray(before_m) - np.asarray(after_m)
    sector = int(np.argmax(change_m))
    return sector if change_m[sector] >= NEARER_M else None


def free_m(distances_m: Sequence[float], direction_rad: float) -> float:
    """How far it is free in a direction, robot frame, and a sector to either side of it."""
    sector = round(direction_rad * SECTORS / math.tau)
    return min(distances_m[(sector + beside) % SECTORS] for beside in (-1, 0, 1))


def box_problems(ahead: int | None, left: int | None) -> list[str]:
    """What is wrong, by where a box straight ahead and one at the left were seen."""
    if ahead is None and left is None:
        return [
            "neither box made a distance shorter: does the scanner see that low? is its topic the right one?"
        ]
    if ahead is None or left is None:
        unseen = "ahead" if ahead is None else "at the left"
        return [f"the box {unseen} made no distance shorter: is the scanner blind there?"]
    ahead_deg, left_deg = _degrees(ahead), _degrees(left - ahead)
    if abs(left_deg - 90) > DEG_PER_SECTOR:
        if abs(left_deg + 90) <= DEG_PER_SECTOR:
            return [
                "the box at the left was seen at the right: scan.upside_down of the robot's file is wrong"
            ]
        return [f"the boxes ahead and at the left were seen {left_deg} degrees apart: put them anew"]
    if abs(ahead_deg) > DEG_PER_SECTOR:
        return [f"the box ahead was seen at {ahead_deg:+d} degrees: take these from scan.yaw_deg"]
    return []


def range_problems(readings_m: Sequence[Sequence[float]], max_range_m: float) -> list[str]:
    """What is wrong with the distances as they come, (N, SECTORS)."""
    told = np.asarray(readings_m)
    if not len(told):
        return ["no distances come: see the log of the robot's service"]
    found = []
    far = float(np.mean(np.median(told, axis=0) >= max_range_m))
    if far >= SILENT_SHARE:
        found.append(f"{far:.0%} of the distances see nothing within {max_range_m:g} m: is this a room?")
    if len(told) > 1 and np.all(told == told[0]) and far < 1.0:
        found.append("all distances are the same again and again: the scanner hangs")
    return found


def _degrees(sectors: int) -> int:
    return round(math.remainder(sectors * DEG_PER_SECTOR, 360))
