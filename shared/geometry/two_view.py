"""Relative pose of two spherical views: the planar model, else the essential matrix."""

import numpy as np
import numpy.typing as npt

from shared.geometry.essential import estimate_essential
from shared.geometry.planar import estimate_planar
from shared.geometry.two_view_types import TwoViewResult, TwoViewSettings, checked_matches

__all__ = ["TwoViewResult", "TwoViewSettings", "two_view"]


def two_view(
    current: npt.ArrayLike,
    target: npt.ArrayLike,
    rng: np.random.Generator,
    settings: TwoViewSettings | None = None,
) -> TwoViewResult:
    """Heading and yaw from matched bearings.

    The general model is asked where the planar one has no answer, is less than half sure, or leaves
    residuals that fill its tolerance; it answers where it explains clearly more matches, as it has two and a
    half times the freedom.

    Args:
        current: (N, 2) longitude, latitude in the current frame, radians.
        target: (N, 2) the same matches in the target frame, radians.
        rng: numpy Generator; the same state and input give the same answer.
        settings: limits; None for the defaults.

    Returns:
        The result; its `model` tells which model answered.

    Raises:
        ValueError: shapes other than (N, 2), or numbers that are not finite.
    """
    limits = settings or TwoViewSettings()
    c, t = checked_matches(current, target)
    planar = estimate_planar(c, t, rng, limits)
    if not limits.fallback or len(c) < limits.fallback_min_matches or _settled(planar, limits):
        return planar
    general = estimate_essential(c, t, rng, limits)
    gain = _cost(planar, limits.threshold_rad) - _cost(general, limits.threshold_rad)
    better = gain >= limits.fallback_gain + 0.05 * len(c)
    return general if general.status in ("ok", "no_baseline") and better else planar


def _cost(result: TwoViewResult, threshold: float) -> float:
    """Truncated squared residuals of all matches in units of the threshold: an outlier costs one."""
    inlier_cost = ((result.noise_rad or 0.0) / threshold) ** 2
    return len(result.inlier_mask) - result.inliers * (1.0 - inlier_cost)


def _settled(planar: TwoViewResult, limits: TwoViewSettings) -> bool:
    """Whether the planar answer stands without asking the general model."""
    if planar.status in ("no_baseline", "too_few"):
        return True
    if not planar.usable:
        return planar.near_misses < limits.fallback_probe
    noisy = planar.noise_rad is None or planar.noise_rad > limits.fallback_noise * limits.threshold_rad
    out_of_reach = planar.near_misses > limits.fallback_near * len(planar.inlier_mask) + 2.0
    few = planar.inliers < limits.fallback_share * len(planar.inlier_mask)
    return not (noisy or out_of_reach or few) and planar.confidence >= 0.5
