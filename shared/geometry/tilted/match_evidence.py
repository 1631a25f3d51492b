"""What each match says about a motion: likelihood ratios against a wrong match. Pure.

A match is right with a probability that its descriptors tell. A right one lies on the epipolar plane within
the noise and has the size that the motion predicts; a wrong one lies anywhere. The evidence of a motion is
the sum of ln(1 + p (L - 1)) over the matches, L being the ratio of both densities: distinctive matches that
do not fit speak against it, dull ones that fit hardly count.
"""

from dataclasses import dataclass

import numpy as np

from shared.geometry.sphere import BoolArray, FloatArray, IndexArray
from shared.geometry.tilted.poses import Evaluated, Poses

NOISE_RAD = float(np.deg2rad(0.3))
"""Spread of right matches about the epipolar plane: 1.3 pixels at 1600 columns; photographs are stitched."""
SCALE_NOISE = 0.2
"""Spread of ln(size ratio) about equation (1) of poses: 0.15 measured, most of it within."""
TAIL_SHARE, TAIL_WIDTH = 0.2, 3.0
"""Share of right matches that err by so many times as much; chosen: stitching, edges of things."""
CHANCE_PER_RAD = 1.0
"""Density of a wrong match's angle off a plane: even over a good half turn."""
CHANCE_SCALE = 0.6
"""Spread of ln(size ratio) of wrong matches, as measured."""
CHANCE_SR = 5.0
"""Solid angle over which wrong matches spread: the picture without its poles, the horizon preferred."""
BEHIND = 2.5
"""Noises by which a match may lie on the wrong side of a camera."""
SEARCHED = 160
"""Matches that hypotheses are drawn from and tried on, the likeliest ones; the answer is judged on all."""
TILT_RAD = float(np.deg2rad(4.0))
"""Usual angle between two cameras' verticals: 1.4 degrees on tripods; robots rock by 3."""
CLIMB_RAD = float(np.deg2rad(8.0))
"""Usual steepness of the way: cameras lean, and stand up to some decimetres higher after metres."""


@dataclass(frozen=True, eq=False)
class Cues:
    """What is known of N matches beside their bearings.

    Attributes:
        right: (N,) probability that a match is right, by its descriptors alone.
        log_scale: (N,) ln(keypoint's size in the current view / in the target); None where sizes are unknown.
    """

    right: FloatArray
    log_scale: FloatArray | None = None

    @property
    def likeliest(self) -> IndexArray:
        """Indices of the matches that a search looks at, the likeliest first."""
        return np.argsort(-self.right, kind="stable")[:SEARCHED]

    @classmethod
    def unknown(cls, count: int) -> "Cues":
        """Nothing is known: every other match is right."""
        return cls(np.full(count, 0.5))


def motion_ratio(seen: Evaluated, noise_rad: float) -> FloatArray:
    """L (K, N) of a motion: how much better it explains each match than chance does."""
    return plane_ratio(seen, noise_rad) * in_front(seen, noise_rad)


def plane_ratio(seen: Evaluated, noise_rad: float) -> FloatArray:
    """The same, wherever a match lies on its epipolar plane."""
    ratio = _tailed(seen.residual, noise_rad, CHANCE_PER_RAD)
    return ratio if seen.scale_error is None else ratio * _size_ratio(seen.scale_error)


def in_front(seen: Evaluated, noise_rad: float, way: float = 1.0, side: float = 1.0) -> BoolArray:
    """Whether each match can be seen by both cameras, (K, N); the signs are those of Poses.opposite."""
    reach = -BEHIND * noise_rad
    return np.asarray((way * seen.forward >= reach) & (side * seen.same_side >= reach), dtype=np.bool_)


def turn_ratio(apart_rad: FloatArray, log_scale: FloatArray | None, noise_rad: float) -> FloatArray:
    """L of a turn on the spot, for matches (..., N) that it leaves `apart_rad` from each other.

    It foretells both coordinates, so that it is far stronger where it holds.
    """
    size = apart_rad / noise_rad
    dense = (1.0 - TAIL_SHARE) * np.exp(-0.5 * size**2)
    dense += TAIL_SHARE / TAIL_WIDTH**2 * np.exp(-0.5 * (size / TAIL_WIDTH) ** 2)
    ratio = dense * CHANCE_SR / (2.0 * np.pi * noise_rad**2)
    if log_scale is not None:
        ratio = ratio * _size_ratio(log_scale)
    return np.asarray(ratio, dtype=np.float64)


def belongs(right: FloatArray, ratio: FloatArray) -> BoolArray:
    """Which matches rather belong to a motion than not: p L > 1 - p."""
    return np.asarray(right * ratio > 1.0 - right, dtype=np.bool_)


def evidence(right: FloatArray, ratio: FloatArray) -> FloatArray:
    """ln(1 + p (L - 1)) of each match, nats."""
    return np.asarray(np.log1p(right * (ratio - 1.0)), dtype=np.float64)


def unlikely(poses: Poses) -> FloatArray:
    """Nats (K,) by which tilt and climb are less likely than none."""
    return 0.5 * ((poses.tilt_rad / TILT_RAD) ** 2 + (poses.elevation_rad / CLIMB_RAD) ** 2)


def _size_ratio(error: FloatArray) -> FloatArray:
    """L of changes of size that are so far, ln, from the foretold ones."""
    return _tailed(error, SCALE_NOISE, 1.0 / (CHANCE_SCALE * np.sqrt(2.0 * np.pi)))


def _tailed(error: FloatArray, width: float, chance: float) -> FloatArray:
    """Density of a normal variable with a wide tail, over that of chance."""
    peak = 1.0 / (chance * width * np.sqrt(2.0 * np.pi))
    exponent = np.square(error)
    exponent *= -0.5 / width**2
    dense = np.exp(exponent)
    dense *= (1.0 - TAIL_SHARE) * peak
    exponent *= TAIL_WIDTH**-2
    tail = np.exp(exponent)
    tail *= TAIL_SHARE / TAIL_WIDTH * peak
    dense += tail
    return np.asarray(dense, dtype=np.float64)
