"""Two-view estimation without the plane: five-point RANSAC on bearings, for ramps and a tilted robot."""

import numpy as np
import numpy.typing as npt

from shared.geometry.essential_model import (
    Pose,
    PoseEvaluation,
    draw_fives,
    evaluate_pose,
    five_point,
    poses_of,
    refine_pose,
    score_essentials,
)
from shared.geometry.evidence import confidence, log_nfa, noise_rad, parallax_share, parallax_z, sign_margin
from shared.geometry.rotation import fit_rotation
from shared.geometry.sphere import BoolArray, FloatArray, angle_between_rad, bearings_from_lonlat, wrap_rad
from shared.geometry.two_view_types import TwoViewResult, TwoViewSettings, checked_matches, refused

REFINED = 3
"""Matrices refined: 1 and 6 answer as many scenes (tests/benchmarks/test_two_view_effort.py)."""
CHANCE_SHIFTS = 16
"""As in planar."""
MIN_HORIZONTAL = 0.5
"""Cosine of 60 degrees: a travel direction that is steeper has no heading; chosen."""
SEARCHED = 10
"""The refinement searches beyond the samples: they count as so many times as many tests; chosen."""
AS_WELL = 0.85
"""Share of the inliers that a turn alone must explain to be considered; chosen: chance adds some to both."""


def estimate_essential(
    current: npt.ArrayLike, target: npt.ArrayLike, rng: np.random.Generator, settings: TwoViewSettings
) -> TwoViewResult:
    """Heading and yaw between two views of any tilt; arguments and result as for estimate_planar.

    The heading is the longitude of the travel direction, the yaw that of the rotation about the vertical.
    """
    c, t = checked_matches(current, target)
    none = np.zeros(len(c), dtype=np.bool_)
    if len(c) < max(settings.min_matches, 6):
        return refused("too_few", none)
    b, bt = bearings_from_lonlat(c), bearings_from_lonlat(t)
    samples = draw_fives(len(c), settings.fallback_samples, rng)
    essentials = five_point(b[samples], bt[samples])
    if len(essentials) == 0:
        return refused("inconsistent", none)
    scores = score_essentials(essentials, b, bt, settings.threshold_rad)
    best = np.argsort(-scores, kind="stable")[:REFINED]
    pose, covariance = _best_pose(essentials[best], b, bt, settings.threshold_rad)
    answer = _judge(pose, covariance, b, bt, SEARCHED * len(essentials), settings)
    rotation, turned = fit_rotation(b, bt, rng, settings.threshold_rad)
    if turned.sum() >= settings.min_inliers and turned.sum() >= AS_WELL * answer.inliers:
        displacement = float(np.median(angle_between_rad(b[turned], bt[turned] @ rotation.T)))
        if not answer.usable or displacement <= settings.no_baseline_noise * (answer.noise_rad or 0.0):
            return _turn_only(rotation, turned, displacement)
    return answer


def _best_pose(
    essentials: FloatArray, b: FloatArray, bt: FloatArray, threshold: float
) -> tuple[Pose, FloatArray]:
    """Refined pose with the best score among the cheirality winners of a few essential matrices."""
    refined = []
    for essential in essentials:
        start = max(poses_of(essential), key=lambda pose: _score(evaluate_pose(pose, b, bt), threshold))
        refined.append(refine_pose(start, b, bt, threshold))
    return max(refined, key=lambda item: _score(evaluate_pose(item[0], b, bt), threshold))


def _score(result: PoseEvaluation, threshold: float) -> float:
    gain = (1.0 - (result.residual / threshold) ** 2) * result.consistent(threshold)
    return float(np.sum(gain)) + 1e-3 * float(np.sum(np.clip(result.forward / threshold, -3.0, 3.0)))


def _judge(
    pose: Pose, covariance: FloatArray, b: FloatArray, bt: FloatArray, tests: int, settings: TwoViewSettings
) -> TwoViewResult:
    """The same questions as for the planar model: chance, a turn on the spot, a loose direction."""
    result = evaluate_pose(pose, b, bt)
    mask = result.consistent(settings.threshold_rad)
    inliers, count = int(mask.sum()), len(mask)
    chance = _chance_rate(pose, b, bt, settings.threshold_rad)
    evidence = log_nfa(inliers, count, chance, 5, tests)
    if inliers < settings.min_inliers or evidence > settings.max_log_nfa:
        return refused("inconsistent", mask)
    noise = noise_rad(result.residual[mask], fitted=5)
    displacement = angle_between_rad(b[mask], bt[mask] @ pose.rotation.T)
    disparity = float(np.median(displacement))
    bound = max(settings.no_baseline_rad, settings.no_baseline_noise * noise)
    if disparity <= bound or parallax_z(result.forward[mask], noise) < settings.min_parallax_z:
        return _turn_only(pose.rotation, mask, disparity)
    level = float(np.hypot(pose.travel[0], pose.travel[1]))
    heading_std = _heading_std_rad(pose.travel, covariance) * noise / parallax_share(disparity, noise)
    if level < MIN_HORIZONTAL or heading_std > settings.max_heading_std_rad:
        return refused("inconsistent", mask)
    near = np.abs(result.residual) <= settings.threshold_rad
    margin = sign_margin(result.forward[near], np.ones(int(near.sum())), noise)
    return TwoViewResult(
        status="ok",
        heading_rad=float(wrap_rad(np.arctan2(pose.travel[1], pose.travel[0]))),
        yaw_rad=_yaw_rad(pose.rotation),
        inlier_mask=mask,
        inliers=inliers,
        confidence=confidence(inliers, count, chance, evidence, heading_std, margin),
        disparity_rad=disparity,
        heading_std_rad=heading_std,
        yaw_std_rad=None,
        sign_margin=margin,
        noise_rad=noise,
        model="essential",
    )


def _turn_only(rotation: FloatArray, mask: BoolArray, disparity: float) -> TwoViewResult:
    return TwoViewResult(
        status="no_baseline",
        heading_rad=None,
        yaw_rad=_yaw_rad(rotation),
        inlier_mask=mask,
        inliers=int(mask.sum()),
        confidence=0.0,
        disparity_rad=disparity,
        heading_std_rad=None,
        yaw_std_rad=None,
        sign_margin=0.0,
        noise_rad=None,
        model="rotation",
    )


def _yaw_rad(rotation: FloatArray) -> float:
    """Turn about the vertical of the swing-twist decomposition."""
    return float(wrap_rad(np.arctan2(rotation[1, 0] - rotation[0, 1], rotation[0, 0] + rotation[1, 1])))


def _heading_std_rad(travel: FloatArray, covariance: FloatArray) -> float:
    """Spread of atan2(t_y, t_x) for unit noise, from the covariance of t."""
    gradient = np.array([-travel[1], travel[0], 0.0]) / max(float(travel[0] ** 2 + travel[1] ** 2), 1e-12)
    return float(np.sqrt(max(float(gradient @ covariance @ gradient), 0.0)))


def _chance_rate(pose: Pose, b: FloatArray, bt: FloatArray, threshold: float) -> float:
    """Share of wrong pairings, made by shifting one list, that fit the pose as well."""
    shifts = np.unique(np.linspace(1, len(b) - 1, CHANCE_SHIFTS).astype(np.intp))
    masks: list[BoolArray] = [
        evaluate_pose(pose, b, np.roll(bt, -k, axis=0)).consistent(threshold) for k in shifts
    ]
    return float(np.clip(np.mean(masks), 1e-3, 0.999))
