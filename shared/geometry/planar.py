"""Planar two-view estimation: fit, then tell a motion from a turn on the spot and from chance."""

from dataclasses import replace

import numpy as np
import numpy.typing as npt

from shared.geometry.evidence import confidence, disparity_rad, log_nfa, parallax_share
from shared.geometry.planar_fit import NoFit, PlanarFit, fit_planar, leverage_weights
from shared.geometry.planar_model import PlanarMatches, evaluate
from shared.geometry.rotation import RotationFit, fit_yaw
from shared.geometry.sphere import BoolArray, FloatArray
from shared.geometry.two_view_types import TwoViewResult, TwoViewSettings, checked_matches, moved, refused

CHANCE_SHIFTS = 16
"""Wrong pairings of each match that tell what chance does: with 8, 1 in 100 unrelated pairs of frames is
answered, with 16 and 32 none (tests/benchmarks/test_two_view_effort.py)."""
WIDE = 4.0
"""Thresholds within which a match counts as nearly right; chosen: 2.8 degrees, a small tilt."""
SPREAD = 0.8
"""Quantile of the displacements that must be small too, for a few near points to make a baseline; chosen."""


def estimate_planar(
    current: npt.ArrayLike, target: npt.ArrayLike, rng: np.random.Generator, settings: TwoViewSettings
) -> TwoViewResult:
    """Heading and yaw between two upright views on one horizontal plane.

    Args:
        current: (N, 2) longitude, latitude of the matches in the current frame, radians.
        target: (N, 2) the same matches in the target frame, radians.
        rng: draws the pairs; the only source of chance.
        settings: limits.

    Returns:
        The result; see TwoViewResult for what each status leaves empty.
    """
    c, t = checked_matches(current, target)
    none = np.zeros(len(c), dtype=np.bool_)
    if len(c) < settings.min_matches:
        return refused("too_few", none)
    matches = PlanarMatches.from_lonlat(c, t)
    rotation = fit_yaw(matches, settings.threshold_rad)
    fit = fit_planar(replace(matches, weight=leverage_weights(rotation.residual_rad)), rng, settings)
    if isinstance(fit, NoFit):
        return refused("inconsistent", fit.mask)
    threshold = settings.threshold_rad
    chance, wide_chance = _chance_rates(fit, matches, [threshold, WIDE * threshold])
    evidence = log_nfa(int(fit.mask.sum()), len(c), chance, 2, 2 * settings.pairs)
    if int(fit.mask.sum()) < settings.min_inliers or evidence > settings.max_log_nfa:
        return refused("inconsistent", fit.mask)
    if _only_turned(rotation, fit, chance, settings):
        return _rotation_result(rotation)
    near = _near_misses(fit, chance, wide_chance, threshold)
    return replace(_accept(fit, matches, chance, evidence, settings), near_misses=near)


def _only_turned(rotation: RotationFit, fit: PlanarFit, chance: float, settings: TwoViewSettings) -> bool:
    """Whether a yaw alone explains what the planar model explains, wrong matches that fit by chance aside.

    Chance may have added twice its mean, and noise a tenth of all inliers, to the planar model's.
    """
    both = fit.mask & rotation.mask
    inliers, count = int(fit.mask.sum()), len(fit.mask)
    stray = (count - inliers) * chance / (1.0 - chance)
    if both.sum() < settings.min_inliers or inliers - both.sum() > 2.0 * stray + 0.1 * inliers:
        return False
    if fit.parallax_z < settings.min_parallax_z:
        return True
    residual = rotation.residual_rad[both]
    bound = max(settings.no_baseline_rad, settings.no_baseline_noise * fit.noise_rad)
    # A few near points with parallax among many far ones still make a baseline: look at the upper part too.
    return bool(np.median(residual) <= bound and np.quantile(residual, SPREAD) <= 2.0 * bound)


def _rotation_result(fit: RotationFit) -> TwoViewResult:
    apart = fit.residual_rad[fit.mask]
    return TwoViewResult(
        status="no_baseline",
        heading_rad=None,
        yaw_rad=fit.yaw_rad,
        inlier_mask=fit.mask,
        inliers=int(fit.mask.sum()),
        confidence=0.0,
        disparity_rad=disparity_rad(apart),
        heading_std_rad=None,
        yaw_std_rad=fit.std_rad,
        sign_margin=0.0,
        noise_rad=None,
        model="rotation",
        moved=moved(apart),
    )


def _accept(
    fit: PlanarFit, matches: PlanarMatches, chance: float, evidence: float, settings: TwoViewSettings
) -> TwoViewResult:
    """Result of a model that chance does not explain, unless its direction is too loose to follow."""
    apart = _apart_rad(fit.yaw_rad, matches, fit.mask)
    disparity = disparity_rad(apart)
    share = parallax_share(disparity, fit.noise_rad)
    heading_std = float(np.sqrt(fit.covariance[0, 0]) / share)
    if heading_std > settings.max_heading_std_rad:
        return refused("inconsistent", fit.mask)
    yaw_variance = fit.covariance[0, 0] + fit.covariance[1, 1] - 2.0 * fit.covariance[0, 1]
    inliers = int(fit.mask.sum())
    return TwoViewResult(
        status="ok",
        heading_rad=fit.phi,
        yaw_rad=fit.yaw_rad,
        inlier_mask=fit.mask,
        inliers=inliers,
        confidence=confidence(inliers, len(fit.mask), chance, evidence, heading_std, fit.sign_margin),
        disparity_rad=disparity,
        heading_std_rad=heading_std,
        yaw_std_rad=float(np.sqrt(max(yaw_variance, 0.0))),
        sign_margin=fit.sign_margin,
        noise_rad=fit.noise_rad,
        model="planar",
        moved=moved(apart),
    )


def _apart_rad(yaw_rad: float, matches: PlanarMatches, mask: BoolArray) -> FloatArray:
    """Angle between the current and the yaw-compensated target bearing of each inlier, radians."""
    (h_current, h_target), (z_current, z_target) = matches.horizontal[:, mask], matches.height[:, mask]
    dot = (h_current * (h_target * np.exp(1j * yaw_rad)).conj()).real + z_current * z_target
    return np.asarray(np.arccos(np.clip(dot, -1.0, 1.0)), dtype=np.float64)


def _chance_rates(fit: PlanarFit, matches: PlanarMatches, thresholds: list[float]) -> list[float]:
    """Share of wrong pairings that fit the model as well: near the horizon almost anything does.

    Wrong pairings are made by shifting the target list against the current one.
    """
    shifts = np.unique(np.linspace(1, len(matches) - 1, CHANCE_SHIFTS).astype(np.intp))
    wrong = matches.wrongly_paired(shifts)
    result = evaluate(wrong, np.array([[fit.phi], [fit.phi_target]]))
    return [float(np.clip(np.mean(result.consistent(x)[0]), 1e-3, 0.999)) for x in thresholds]


def _near_misses(fit: PlanarFit, chance: float, wide_chance: float, threshold: float) -> float:
    """Matches between one and four thresholds from the model, less those expected by chance.

    A tilted camera leaves many: right matches that the plane cannot reach.
    """
    wide = int((fit.seen.consistent(WIDE * threshold)[0][0] & ~fit.mask).sum())
    outliers = int((~fit.mask).sum())
    return max(wide - outliers * max(wide_chance - chance, 0.0), 0.0)
