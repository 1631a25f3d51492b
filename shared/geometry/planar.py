"""Planar two-view RANSAC: travel direction and yaw from matched bearings (THESIS 1c; equations in planar_model).

Draw pairs of matches, solve each for (phi, phi'), score all hypotheses on all matches at once with the truncated
squared distance, refine the best few together by iterated reweighted Gauss-Newton, and judge the winner.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from shared.geometry.angles import FloatArray, wrap_rad
from shared.geometry.planar_model import Evaluation, PlanarMatches, evaluate, solve_pairs
from shared.geometry.planar_refine import noise_rad, refine
from shared.geometry.rotation_only import RotationFit, fit_yaw
from shared.geometry.two_view_judge import confidence, log_nfa
from shared.geometry.two_view_types import BoolArray, TwoViewResult, TwoViewSettings, checked_matches, refused

REFINED = 6
CHANCE_SHIFTS = 16


@dataclass(frozen=True, eq=False)
class PlanarFit:
    """The winning planar model: phi, phi' (rad), its (N,) inliers, score and covariance of (phi, phi')."""

    phi: float
    phi_target: float
    mask: BoolArray
    noise_rad: float
    covariance: FloatArray
    sign_margin: float


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
    count = len(c)
    if count < settings.min_matches:
        return refused("too_few", np.zeros(count, dtype=np.bool_))
    matches = PlanarMatches.from_lonlat(c, t)
    rotation = fit_yaw(matches, settings.threshold_rad)
    fit = fit_planar(matches, rng, settings)
    planar_mask = rotation.mask if fit is None else fit.mask
    if _only_turned(rotation, planar_mask, None if fit is None else fit.noise_rad, settings):
        return _rotation_result(rotation)
    if fit is None:
        return refused("inconsistent", np.zeros(count, dtype=np.bool_))
    return _judge(fit, c, t, matches, settings)


def fit_planar(matches: PlanarMatches, rng: np.random.Generator, settings: TwoViewSettings) -> PlanarFit | None:
    """Best planar model by score, or None where no pair of matches constrains it."""
    phi, phi_target = solve_pairs(matches.rows, draw_pairs(len(matches.rows), settings.pairs, rng))
    if len(phi) == 0:
        return None
    threshold = settings.threshold_rad
    score, flip = _signed_scores(evaluate(matches, phi, phi_target), threshold)
    best = np.argsort(-score, kind="stable")[:REFINED]
    turn = np.where(flip[best], np.pi, 0.0)
    phi, phi_target, covariance = refine(matches, phi[best] + turn, phi_target[best] + turn, threshold)
    result = evaluate(matches, phi, phi_target)
    score, flip = _signed_scores(result, threshold)
    k = int(np.argmax(score))
    forward, backward = result.consistent(threshold)
    mask = backward[k] if flip[k] else forward[k]
    turn_k = np.pi if flip[k] else 0.0
    signed = (-1.0 if flip[k] else 1.0) * result.forward[k]
    near = np.abs(result.residual[k]) <= threshold
    noise = noise_rad(result.residual[k][mask], threshold)
    return PlanarFit(
        phi=float(wrap_rad(phi[k] + turn_k)),
        phi_target=float(wrap_rad(phi_target[k] + turn_k)),
        mask=mask,
        noise_rad=noise,
        covariance=covariance[k] * noise**2,
        sign_margin=_sign_margin(signed[near], noise),
    )


def draw_pairs(count: int, pairs: int, rng: np.random.Generator) -> npt.NDArray[np.intp]:
    """Index pairs (P, 2) of different matches: all of them where they are few, else `pairs` random ones."""
    if count * (count - 1) // 2 <= pairs:
        return np.stack(np.triu_indices(count, 1), axis=1)
    first = rng.integers(0, count, pairs)
    second = (first + rng.integers(1, count, pairs)) % count
    return np.stack([first, second], axis=1)


def _signed_scores(result: Evaluation, threshold: float) -> tuple[FloatArray, BoolArray]:
    """Score of the better sign, (H,), and whether that is the opposite direction (cheirality)."""
    gain = 1.0 - (result.residual / threshold) ** 2
    forward, backward = result.consistent(threshold)
    plus, minus = np.sum(gain * forward, axis=1), np.sum(gain * backward, axis=1)
    # Displacements within the noise count for both signs: their mean decides a tie.
    tie = 1e-3 * np.sum(np.clip(result.forward / threshold, -3.0, 3.0) * (forward | backward), axis=1)
    plus, minus = plus + tie, minus - tie
    return np.maximum(plus, minus), minus > plus


def _sign_margin(forward: FloatArray, noise: float) -> float:
    """How clearly matches near the plane move away from the direction of travel: mean of clipped evidence, [0, 1]."""
    if len(forward) == 0:
        return 0.0
    evidence = np.clip(forward / max(3.0 * noise, 1e-9), -1.0, 1.0)
    total = float(np.sum(np.abs(evidence)))
    return float(np.clip(np.sum(evidence) / max(total, 1e-9), 0.0, 1.0))


def _only_turned(rotation: RotationFit, mask: BoolArray, noise: float | None, settings: TwoViewSettings) -> bool:
    """Whether a yaw alone explains what the planar model explains."""
    if rotation.mask.sum() < settings.min_inliers or rotation.mask.sum() < 0.6 * mask.sum():
        return False
    residual = rotation.residual_rad[mask]
    bound = max(settings.no_baseline_rad, settings.no_baseline_noise * (noise or 0.0))
    # A few near points with parallax among many far ones still make a baseline: look at the upper part as well.
    return bool(np.median(residual) <= bound and np.quantile(residual, 0.8) <= 2.0 * bound)


def _rotation_result(fit: RotationFit) -> TwoViewResult:
    disparity = float(np.median(fit.residual_rad[fit.mask]))
    return TwoViewResult(
        "no_baseline", None, fit.yaw_rad, fit.mask, int(fit.mask.sum()), 0.0, disparity, None, fit.std_rad, 0.0, "rotation"
    )


def _judge(
    fit: PlanarFit, current: FloatArray, target: FloatArray, matches: PlanarMatches, settings: TwoViewSettings
) -> TwoViewResult:
    """Accept or refuse the winner: enough inliers, more than chance gives, and a direction that is pinned down."""
    inliers, count = int(fit.mask.sum()), len(fit.mask)
    if inliers < settings.min_inliers:
        return refused("inconsistent", fit.mask)
    chance = _chance_rate(fit, current, target, settings.threshold_rad)
    alarms = log_nfa(inliers, count, chance, 2, 2 * settings.pairs)
    heading_std = float(np.sqrt(fit.covariance[0, 0]))
    if alarms > settings.max_log_nfa or heading_std > settings.max_heading_std_rad:
        return refused("inconsistent", fit.mask)
    yaw = float(wrap_rad(fit.phi - fit.phi_target))
    yaw_var = fit.covariance[0, 0] + fit.covariance[1, 1] - 2.0 * fit.covariance[0, 1]
    dot = matches.dot @ np.array([np.cos(yaw), np.sin(yaw), 1.0])
    disparity = float(np.median(np.arccos(np.clip(dot[fit.mask], -1.0, 1.0))))
    trust = confidence(inliers, count, chance, alarms, heading_std, fit.sign_margin)
    return TwoViewResult(
        status="ok",
        heading_rad=fit.phi,
        yaw_rad=yaw,
        inlier_mask=fit.mask,
        inliers=inliers,
        confidence=trust,
        disparity_rad=disparity,
        heading_std_rad=heading_std,
        yaw_std_rad=float(np.sqrt(max(yaw_var, 0.0))),
        sign_margin=fit.sign_margin,
        model="planar",
    )


def _chance_rate(fit: PlanarFit, current: FloatArray, target: FloatArray, threshold: float) -> float:
    """Share of wrong pairings that fit the model as well: near the horizon almost anything does.

    Wrong pairings are made by shifting the target list against the current one.
    """
    count = len(current)
    shifts = np.unique(np.linspace(1, count - 1, CHANCE_SHIFTS).astype(np.intp))
    order = (np.arange(count)[None, :] + shifts[:, None]) % count
    wrong = PlanarMatches.from_lonlat(np.tile(current, (len(shifts), 1)), target[order.ravel()])
    result = evaluate(wrong, np.array([fit.phi]), np.array([fit.phi_target]))
    forward, _ = result.consistent(threshold)
    return float(np.clip(np.mean(forward), 1e-3, 0.999))
