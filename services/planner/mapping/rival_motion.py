"""Whether a second motion explains a match: a wall or a fence whose pattern repeats (decision 0015). Pure.

Most matches along such a wall are shifted by a multiple of its period and agree on a wrong direction; the
rest agree on the right one. What is far away moves for neither: it is no evidence of a direction, and it
holds the yaw for both.
"""

import math

import numpy as np

from shared.geometry.sphere import BoolArray, FloatArray, angle_between_rad, bearings_from_lonlat
from shared.geometry.two_view import TwoViewSettings, two_view
from shared.geometry.two_view_types import MOVED_RAD
from shared.messages.matching import NodeMatch

LEAST = 6
LEAST_SHARE = 0.12
SURE = 0.8
APART_RAD = math.radians(10.0)
SAME_YAW_RAD = math.radians(6.0)
"""When there is a second motion: so many moved matches, so large a share of the first one's, so sure, in a
direction so far apart, with the same yaw: a repeating wall keeps the camera's yaw; things that look alike on
two sides do not, and mislead nobody."""


def is_ambiguous(match: NodeMatch) -> bool:
    """Whether two motions of the camera explain a match. False where its matches did not come along."""
    if match.status != "ok" or match.matches_rad is None or match.inlier_mask is None:
        return False
    if match.heading_rad is None or match.yaw_rad is None:
        return False
    rows = match.matches_rad.astype(np.float64)
    explained = match.inlier_mask.astype(bool) & _moved(rows, match.yaw_rad)
    rest = rows[~explained]
    if len(rest) < LEAST:
        return False
    rng = np.random.default_rng([match.raw_matches, match.inliers])
    other = two_view(rest[:, :2], rest[:, 2:], rng, TwoViewSettings(tilting=False))
    if other.status != "ok" or other.heading_rad is None or other.yaw_rad is None:
        return False
    support = int((other.inlier_mask & _moved(rest, other.yaw_rad)).sum())
    return (
        other.confidence >= SURE
        and support >= max(LEAST, LEAST_SHARE * int(explained.sum()))
        and abs(math.remainder(other.heading_rad - match.heading_rad, math.tau)) > APART_RAD
        and abs(math.remainder(other.yaw_rad - match.yaw_rad, math.tau)) < SAME_YAW_RAD
    )


def _moved(rows: FloatArray, yaw_rad: float) -> BoolArray:
    """Which of (N, 4) matched longitudes and latitudes, radians, the yaw alone does not explain."""
    current, target = bearings_from_lonlat(rows[:, :2]), bearings_from_lonlat(rows[:, 2:] + [yaw_rad, 0.0])
    return np.asarray(angle_between_rad(current, target) > MOVED_RAD, dtype=np.bool_)
