"""Relative pose of two spherical views: the planar model."""

import numpy as np
import numpy.typing as npt

from shared.geometry.planar import estimate_planar
from shared.geometry.two_view_types import TwoViewResult, TwoViewSettings

__all__ = ["TwoViewResult", "TwoViewSettings", "two_view"]


def two_view(
    current: npt.ArrayLike,
    target: npt.ArrayLike,
    rng: np.random.Generator,
    settings: TwoViewSettings | None = None,
) -> TwoViewResult:
    """Heading and yaw from matched bearings.

    Args:
        current: (N, 2) longitude, latitude in the current frame, radians.
        target: (N, 2) the same matches in the target frame, radians.
        rng: numpy Generator; the same state and input give the same answer.
        settings: limits; None for the defaults.
    """
    return estimate_planar(current, target, rng, settings or TwoViewSettings())
