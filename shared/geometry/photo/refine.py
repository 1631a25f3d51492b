"""The pose of a photo from matches with panoramas of known places, by reweighted Gauss-Newton. Pure."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from shared.geometry.photo.plane import NARROWEST_RAD, WIDEST_RAD, area_sr, focal_of
from shared.geometry.photo.sightings import (
    SCALE_NOISE,
    PhotoPose,
    Sightings,
    belonging,
    likelihood_ratio,
    misses,
)
from shared.geometry.sphere import FloatArray
from shared.geometry.tilted.refine import exponential

COARSE_RAD = tuple(np.deg2rad([5.0, 3.5, 2.4, 1.6]).tolist())
FINE_RAD = tuple(np.deg2rad([1.1, 0.8, 0.55, 0.4, *[0.3] * 10]).tolist())
"""Noise assumed step by step, down to that of sightings; then on along the valley of nearer by and wider."""
LEVEL_M, HIGHER_M = 1.2, 0.4
"""How far from the start, along the floor and upwards, a photo usually is; chosen: nodes stand 0.7 m apart,
and people hold a phone half a metre above the camera of the robot."""
UNKNOWN_LOG_FOCAL, KNOWN_LOG_FOCAL = 0.35, 0.015
"""Spread of ln f of phones about the usual one, of which 50 and 110 degrees are 1.5 away; and of what a file
says: whole millimetres of a film's, a lens that bends lines."""
MOST_STEP = np.array([0.15, 0.15, 0.15, 0.35, 0.35, 0.35, 0.15])
"""Longest step of a turn (rad), a way (m) and ln f; chosen: none leaves what it refines."""
DIFFERENCE = np.array([1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3, 1e-4])
"""Of the numeric derivatives, far below the noise."""


def refine(
    seen: Sightings,
    start: PhotoPose,
    noises_rad: Sequence[float],
    usual_log_focal: float,
    *,
    focal_known: bool,
) -> PhotoPose:
    """Maximum a posteriori pose.

    Args:
        seen: the matches.
        start: where to begin.
        noises_rad: noise assumed in each step, from wide to narrow.
        usual_log_focal: about what ln f is.
        focal_known: it is that of the photo, not that of phones.
    """
    pose = start
    spread = np.array([LEVEL_M, LEVEL_M, HIGHER_M, focal_spread(focal_known)])
    information = np.concatenate([np.zeros(3), spread**-2])
    for noise_rad in noises_rad:
        weight = np.sqrt(belonging(seen, likelihood_ratio(misses(seen, pose), noise_rad)))
        base = _residuals(seen, pose, weight, noise_rad)
        columns = [
            (_residuals(seen, _moved(pose, DIFFERENCE[k] * np.eye(7)[k]), weight, noise_rad) - base)
            / DIFFERENCE[k]
            for k in range(7)
        ]
        jacobian = np.stack(columns, axis=1)
        off = np.zeros(7)
        off[3:6] = pose.position_m - start.position_m
        off[5] = pose.position_m[2]
        off[6] = pose.log_focal - usual_log_focal
        normal = jacobian.T @ jacobian + np.diag(information + 1e-6)
        gradient = jacobian.T @ base + information * off
        gradient[6] -= float(weight @ weight) * _log_area_by_log_focal(seen, pose)
        step = -np.linalg.solve(normal, gradient)
        pose = _moved(pose, np.clip(step, -MOST_STEP, MOST_STEP))
        if not focal_known:
            pose = replace(pose, log_focal=float(np.clip(pose.log_focal, *_phones())))
    return pose


def _log_area_by_log_focal(seen: Sightings, pose: PhotoPose) -> float:
    """Derivative of ln(solid angle of the photo): where it is small, small errors mean less."""
    at, beside = (area_sr(float(np.exp(pose.log_focal + d)), seen.short) for d in (0.0, DIFFERENCE[6]))
    return float(np.log(beside / at) / DIFFERENCE[6])


def focal_spread(focal_known: bool) -> float:
    """Spread of ln f about what is told or usual."""
    return KNOWN_LOG_FOCAL if focal_known else UNKNOWN_LOG_FOCAL


def _phones() -> tuple[float, float]:
    """Least and greatest ln f that is looked for."""
    return float(np.log(focal_of(WIDEST_RAD))), float(np.log(focal_of(NARROWEST_RAD)))


def _residuals(seen: Sightings, pose: PhotoPose, weight: FloatArray, noise_rad: float) -> FloatArray:
    """(3 M,) in units of the noise, by the root of how much each match belongs."""
    missed = misses(seen, pose)
    parts = (missed.across_rad / noise_rad, missed.beyond_rad / noise_rad, missed.log_scale / SCALE_NOISE)
    return np.concatenate([part * weight for part in parts])


def _moved(pose: PhotoPose, step: FloatArray) -> PhotoPose:
    log_focal = pose.log_focal + float(step[6])
    turned = exponential(step[None, :3])[0] @ pose.rotation
    return PhotoPose(turned, pose.position_m + step[3:6], log_focal)
