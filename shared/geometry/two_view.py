"""Relative pose of two spherical views: the planar model first, the essential matrix where it explains too little."""

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

    The fallback answers only where the planar model has no answer, or one that it is less than half sure of, and
    where it explains clearly more matches: it has two and a half times the freedom.

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
    settled = planar.status in ("no_baseline", "too_few") or planar.confidence >= 0.5
    if settled or not limits.fallback or len(c) < limits.fallback_min_matches:
        return planar
    general = estimate_essential(c, t, rng, limits)
    wins = general.usable and general.inliers >= limits.fallback_gain * planar.inliers
    return general if wins else planar
