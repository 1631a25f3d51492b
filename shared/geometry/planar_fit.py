"""Planar two-view RANSAC: the search for the best (phi, phi') (equations in planar_model).

Draw pairs of matches, solve each, score all lines of travel on all matches at once with the truncated squared
distance, tell the signs of the best apart by cheirality, and refine the best few together.
"""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from shared.geometry.evidence import noise_rad, parallax_z, quantile, sign_margin
from shared.geometry.planar_model import Evaluation, PlanarMatches, evaluate, line_scores, solve_pairs
from shared.geometry.planar_refine import refine
from shared.geometry.sphere import BoolArray, FloatArray, wrap_rad
from shared.geometry.two_view_types import TwoViewSettings

# Half and twice of each of these change answers by 1 % at most (tests/benchmarks/test_two_view_effort.py).
SIGNED = 48
"""Lines of travel whose two signs are told apart."""
REFINED = 6
"""Models refined; with 3 a camera that only turned is answered with a direction 2.5 times in 100, not 1.5."""
PARALLAX_REACH = 6.0
"""Displacements up to so many times the usual one are ordinary; chosen: rooms are not spheres."""
PARALLAX_FLOOR_RAD = float(np.deg2rad(0.3))
"""Least usual displacement: TwoViewSettings.no_baseline_rad."""
REACH = 2.0
"""Thresholds from which the refinement can still pull a match in: where its weights begin."""


@dataclass(frozen=True, eq=False)
class PlanarFit:
    """The winning planar model.

    Attributes:
        phi: direction of travel, current frame, radians.
        phi_target: the same direction in the target frame, radians.
        seen: it against all matches.
        mask: (N,) inliers: near the epipolar plane and in front of both cameras.
        noise_rad: standard deviation of their residuals, radians.
        covariance: (2, 2) of (phi, phi'), radians squared.
        sign_margin: [0, 1], share of the parallax evidence that speaks for this sign.
        parallax_z: mean displacement of the inliers away from phi, in standard deviations of that mean under
            noise.
    """

    phi: float
    phi_target: float
    seen: Evaluation
    mask: BoolArray
    noise_rad: float
    covariance: FloatArray
    sign_margin: float
    parallax_z: float

    @property
    def yaw_rad(self) -> float:
        """Rotation of the target frame seen from the current one, radians."""
        return float(wrap_rad(self.phi - self.phi_target))


@dataclass(frozen=True, eq=False)
class NoFit:
    """No model; (N,) `mask` tells which matches agreed best."""

    mask: BoolArray


def fit_planar(
    matches: PlanarMatches, rng: np.random.Generator, settings: TwoViewSettings
) -> PlanarFit | NoFit:
    """Best planar model by score.

    There is none where no pair of matches constrains it, or where fewer than `min_inliers` lie within reach
    of a refinement: half of the work is saved on most wrong pairs of frames (measured: 94 of 100 of them, and
    none of 787 right ones).
    """
    threshold = settings.threshold_rad
    directions = solve_pairs(matches.rows, draw_pairs(len(matches), settings.pairs, rng))
    if directions.size == 0:
        return NoFit(np.zeros(len(matches), dtype=np.bool_))
    lines = np.argsort(-line_scores(matches, directions, threshold), kind="stable")[:SIGNED]
    directions = directions[:, lines]
    score, turn = _signed_scores(evaluate(matches, directions), matches.weight, threshold)
    best = np.argsort(-score, kind="stable")[:REFINED]
    directions = directions[:, best] + turn[best]
    start = evaluate(matches, directions)
    if _most(start.consistent(REACH * threshold)[0]) < settings.min_inliers:
        return NoFit(start.consistent(threshold)[0][0])
    directions, covariance = refine(matches, directions, threshold)
    score, turn = _signed_scores(evaluate(matches, directions), matches.weight, threshold)
    k = int(np.argmax(score))
    return _winner(matches, directions[:, k] + turn[k], covariance[:, :, k], threshold)


def _most(masks: BoolArray) -> int:
    return int(masks.sum(axis=1).max())


def draw_pairs(count: int, pairs: int, rng: np.random.Generator) -> npt.NDArray[np.intp]:
    """Index pairs (P, 2) of different matches: all of them where they are few, else `pairs` random ones."""
    if count * (count - 1) // 2 <= pairs:
        return _all_pairs(count)
    first = rng.integers(0, count, pairs)
    second = (first + rng.integers(1, count, pairs)) % count
    return np.stack([first, second], axis=1)


@cache
def _all_pairs(count: int) -> npt.NDArray[np.intp]:
    """All index pairs of so few matches that each call asks for one of a handful of counts; read only."""
    pairs = np.stack(np.triu_indices(count, 1), axis=1)
    pairs.flags.writeable = False
    return pairs


def leverage_weights(parallax_rad: FloatArray) -> FloatArray:
    """Weights (N,) that bound the influence of displacements far above the usual one.

    Over a short baseline the direction hangs on small displacements, and a wrong match that happens to lie
    near the epipolar plane moves a hundred times as far. The usual displacement is the lower quartile of all
    after the best yaw: it comes from right matches as long as they are a quarter of all.
    """
    scale = PARALLAX_REACH * max(quantile(parallax_rad, 0.25), PARALLAX_FLOOR_RAD)
    return np.asarray(1.0 / (1.0 + (parallax_rad / scale) ** 2), dtype=np.float64)


def _winner(
    matches: PlanarMatches, direction: FloatArray, covariance: FloatArray, threshold: float
) -> PlanarFit:
    seen = evaluate(matches, direction[:, None])
    mask = seen.consistent(threshold)[0][0]
    noise = noise_rad(seen.residual[0][mask])
    near = np.abs(seen.residual[0]) <= threshold
    phi, phi_target = wrap_rad(direction).tolist()
    return PlanarFit(
        phi=phi,
        phi_target=phi_target,
        seen=seen,
        mask=mask,
        noise_rad=noise,
        covariance=covariance * noise**2,
        sign_margin=sign_margin(seen.forward[0][near], matches.weight[near], noise),
        parallax_z=parallax_z(seen.forward[0][mask], noise),
    )


def _signed_scores(result: Evaluation, weight: FloatArray, threshold: float) -> tuple[FloatArray, FloatArray]:
    """Score (H,) of the better sign, and the turn (H,) that leads to it: 0 or pi (cheirality)."""
    gain = weight * (1.0 - (result.residual / threshold) ** 2)
    forward, backward = result.consistent(threshold)
    plus, minus = np.sum(gain * forward, axis=1), np.sum(gain * backward, axis=1)
    # Displacements within the noise count for both signs: their mean decides a tie.
    tie = 1e-3 * np.sum(np.clip(result.forward / threshold, -3.0, 3.0) * (forward | backward), axis=1)
    plus, minus = plus + tie, minus - tie
    return np.maximum(plus, minus), np.where(minus > plus, np.pi, 0.0)
