"""sensor_msgs/LaserScan to the twelve sectors of topnav. Pure.

A reading is a hit, nothing in range (infinite, or beyond `max_m`), too near to measure (-infinite, REP 117),
or no reading at all (NaN, outside of what the scanner says it measures). A sector with too few readings is
blind: it counts as occupied, so that nothing is driven into that was not looked at.
"""

import math
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from services.ros.conversions.header import ConversionError
from shared.messages.base import SECTORS

FloatArray = npt.NDArray[np.float64]

BLIND_M = 0.4
"""Distance of a blind sector: nearer than any direction that is driven along (radius 0.305 and look-ahead
0.12 m, services/drive/passing.py), and far enough that a robot beside it can turn away."""
READ_SHARE = 0.5
"""Of a whole scan, so many readings must be some; chosen: fewer is a scanner that does not work."""
SECTOR_SHARE = 0.25
"""Of a sector; chosen: a dark chair leg may swallow most of one."""
MOST_READINGS = 100_000
PROFILE_BINS = 72
"""Of the profile that motion is checked against; chosen: 5 degrees each."""

Nothing = Literal["inf", "nan", "zero"]
"""How a driver writes that nothing was in range."""


@dataclass(frozen=True)
class Mount:
    """Where the scanner sits on the robot.

    Attributes:
        x_m, y_m: ahead of, and left of the robot's centre.
        yaw_rad: direction of its zero, robot frame.
        upside_down: mounted so: it counts clockwise, seen from above.
    """

    x_m: float = 0.0
    y_m: float = 0.0
    yaw_rad: float = 0.0
    upside_down: bool = False


@dataclass(frozen=True)
class Sectors:
    """What a scan says.

    Attributes:
        distances_m: per sector, 30 degrees apart, 0 ahead, counter-clockwise, from the robot's centre.
        blind: sectors with too few readings.
        profile_m: (PROFILE_BINS,) nearest hit round the robot, NaN where there is none.
    """

    distances_m: tuple[float, ...]
    blind: tuple[int, ...]
    profile_m: FloatArray


def sectors_of(
    scan: Any, mount: Mount, own_radius_m: float, max_m: float, nothing: Nothing = "inf"
) -> Sectors:
    """Convert a scan.

    Args:
        scan: sensor_msgs/LaserScan.
        mount: of the scanner.
        own_radius_m: what is nearer to the robot's centre is the robot itself.
        max_m: longest distance that is told.
        nothing: how its driver writes that nothing was in range.

    Raises:
        ConversionError: it cannot be a scan, or has too few readings.
    """
    angles_rad, ranges_m = _checked(scan)
    hit, free = _kinds(scan, ranges_m, max_m, nothing)
    near = np.isneginf(ranges_m)
    read = hit | free | near
    if read.mean() < READ_SHARE:
        raise ConversionError(
            f"{int(read.sum())} of {len(read)} readings are some, {READ_SHARE:.0%} expected; where the "
            "driver writes NaN or 0 for nothing in range, say so in the robot's file (scan.nothing)"
        )
    far_m = np.where(hit, ranges_m, np.where(near, scan.range_min, max_m))
    turns = -1.0 if mount.upside_down else 1.0
    bearings_rad = mount.yaw_rad + turns * angles_rad
    x_m = mount.x_m + far_m * np.cos(bearings_rad)
    y_m = mount.y_m + far_m * np.sin(bearings_rad)
    distances_m = np.where(free, max_m, np.hypot(x_m, y_m))
    around_rad = np.where(free, bearings_rad, np.arctan2(y_m, x_m))
    other = read & (free | (distances_m > own_radius_m))
    return _summed(bearings_rad, around_rad, np.minimum(distances_m, max_m), read, other, free, max_m)


def _checked(scan: Any) -> tuple[FloatArray, FloatArray]:
    """Angles (scanner's frame) and ranges of a scan that makes sense."""
    ranges_m = np.asarray(scan.ranges, dtype=np.float64)
    numbers = (scan.angle_min, scan.angle_increment, scan.range_min, scan.range_max)
    if not all(math.isfinite(number) for number in numbers):
        raise ConversionError(f"angles and limits must be finite, got {numbers}")
    if not SECTORS <= len(ranges_m) <= MOST_READINGS:
        raise ConversionError(f"{SECTORS} to {MOST_READINGS} readings expected, got {len(ranges_m)}")
    if scan.angle_increment == 0.0 or abs(scan.angle_increment) * (len(ranges_m) - 1) > 2.0 * math.tau:
        raise ConversionError(
            f"two turns in all at most expected, got a step of {scan.angle_increment:.6g} rad"
        )
    if abs(scan.angle_min) > 2.0 * math.tau:
        raise ConversionError(f"angle_min within two turns expected, got {scan.angle_min:.6g} rad")
    if not 0.0 <= scan.range_min < scan.range_max:
        raise ConversionError(f"range_min below range_max expected, got {scan.range_min}, {scan.range_max}")
    return scan.angle_min + np.arange(len(ranges_m)) * scan.angle_increment, ranges_m


def _kinds(
    scan: Any, ranges_m: FloatArray, max_m: float, nothing: Nothing
) -> tuple[npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Which readings are hits, and which say that nothing is in range."""
    free = np.isposinf(ranges_m)
    if nothing == "nan":
        free |= np.isnan(ranges_m)
    elif nothing == "zero":
        free |= ranges_m == 0.0
    measured = (ranges_m >= scan.range_min) & (ranges_m <= scan.range_max) & np.isfinite(ranges_m) & ~free
    beyond = measured & (ranges_m >= max_m)
    return measured & ~beyond, free | beyond


def _summed(
    bearings_rad: FloatArray,
    around_rad: FloatArray,
    distances_m: FloatArray,
    read: npt.NDArray[np.bool_],
    other: npt.NDArray[np.bool_],
    free: npt.NDArray[np.bool_],
    max_m: float,
) -> Sectors:
    """Nearest distance by sector and by bin. Blind is by where the scanner looked, near by where it hit."""
    looked = _bins(bearings_rad, SECTORS)
    rays = np.bincount(looked, minlength=SECTORS)
    readings = np.bincount(looked, weights=read, minlength=SECTORS)
    usual = max(1.0, float(np.median(rays[rays > 0])))
    blind = readings < SECTOR_SHARE * usual
    nearest_m = np.full(SECTORS, max_m)
    np.minimum.at(nearest_m, _bins(around_rad[other], SECTORS), distances_m[other])
    nearest_m[blind] = np.minimum(nearest_m[blind], BLIND_M)
    profile_m = np.full(PROFILE_BINS, np.inf)
    hits = other & ~free
    np.minimum.at(profile_m, _bins(around_rad[hits], PROFILE_BINS), distances_m[hits])
    profile_m[np.isinf(profile_m)] = np.nan
    told = tuple(float(distance) for distance in nearest_m)
    return Sectors(told, tuple(int(i) for i in np.flatnonzero(blind)), profile_m)


def _bins(angles_rad: FloatArray, count: int) -> npt.NDArray[np.int64]:
    """Number of the bin that is centred nearest, counter-clockwise from straight ahead."""
    bins: npt.NDArray[np.int64] = np.round(angles_rad * count / math.tau).astype(np.int64) % count
    return bins
