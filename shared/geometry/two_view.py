"""Relative pose of two spherical views: level cameras on a plane, else cameras that lean."""

import numpy as np
import numpy.typing as npt
from numpy.random import Generator

from shared.geometry.planar import estimate_planar
from shared.geometry.rotation import fit_rotation
from shared.geometry.sphere import FloatArray, bearings_from_lonlat
from shared.geometry.tilted.estimate import estimate_tilted
from shared.geometry.tilted.match_evidence import NOISE_RAD, Cues
from shared.geometry.two_view_types import TwoViewResult, TwoViewSettings, checked_matches

__all__ = ["Cues", "TwoViewResult", "TwoViewSettings", "two_view"]

SHORT_RAD = float(np.deg2rad(3.0))
"""Disparity up to which leaning may pass for a way; more than that level cameras cannot explain."""
AS_WELL = 0.7
"""Share of the inliers of level cameras that a turn must explain to be considered; chosen."""


def two_view(
    current: npt.ArrayLike,
    target: npt.ArrayLike,
    rng: Generator,
    settings: TwoViewSettings | None = None,
    cues: Cues | None = None,
) -> TwoViewResult:
    """Heading and yaw from matched bearings.

    Level cameras on one plane are tried first: two matches fix them, so that they stand out best among wrong
    matches, and a robot on a floor is as good as level most of the time. Where their motion leaves doubts,
    rotation and travel are free.

    Args:
        current: (N, 2) longitude, latitude in the current frame, radians.
        target: (N, 2) the same matches in the target frame, radians.
        rng: numpy Generator; the same state and input give the same answer.
        settings: limits; None for the defaults.
        cues: how likely each match is right and how large it is in both views; None where that is unknown.

    Returns:
        The result; its `model` tells which model answered.

    Raises:
        ValueError: shapes other than (N, 2), or numbers that are not finite.
    """
    limits = settings or TwoViewSettings()
    c, t = checked_matches(current, target)
    planar = estimate_planar(c, t, rng, limits)
    known = cues or Cues.unknown(len(c))
    if not limits.tilting or float(known.right.sum()) < limits.tilting_min_right:
        return planar
    if _settled(planar, limits) and not _only_leans(planar, c, t, rng):
        return planar
    return estimate_tilted(c, t, known, rng, limits)


def _only_leans(planar: TwoViewResult, current: FloatArray, target: FloatArray, rng: Generator) -> bool:
    """Whether a short way may be none: the camera leans, and a turn about any axis explains it as well."""
    if planar.disparity_rad is None or planar.disparity_rad > SHORT_RAD:
        return False
    b, bt = bearings_from_lonlat(current), bearings_from_lonlat(target)
    _, turned = fit_rotation(b, bt, rng, NOISE_RAD)
    return bool(turned.sum() >= AS_WELL * planar.inliers)


def _settled(planar: TwoViewResult, limits: TwoViewSettings) -> bool:
    """Whether the answer of level cameras leaves no doubt."""
    if planar.noise_rad is None or planar.disparity_rad is None:
        return False
    count = len(planar.inlier_mask)
    most = min(limits.settled_noise * limits.threshold_rad, limits.settled_blur * planar.disparity_rad)
    noisy = planar.noise_rad > most
    out_of_reach = planar.near_misses > limits.settled_near * count + 2.0
    few = planar.inliers < limits.settled_share * count
    return not (noisy or out_of_reach or few) and planar.confidence >= 0.5
