"""Two views of cameras that lean: the likeliest motion, told from a turn on the spot and from chance.

Cameras on tripods lean by 1.4 degrees to each other at the median, robots rock; taken for level, a camera
that leans seems to travel. Here rotation and travel are free, and leaning is only less likely.
"""

from dataclasses import dataclass

import numpy as np

from shared.geometry.evidence import NOISE_FLOOR_RAD, disparity_rad, parallax_share
from shared.geometry.planar_model import PlanarMatches
from shared.geometry.rotation import fit_rotation
from shared.geometry.sphere import BoolArray, FloatArray, angle_between_rad, bearings_from_lonlat, wrap_rad
from shared.geometry.tilted.match_evidence import NOISE_RAD, Cues, belongs, evidence, motion_ratio, turn_ratio
from shared.geometry.tilted.poses import Bearings, Poses, evaluate, yaw_of
from shared.geometry.tilted.search import search
from shared.geometry.two_view_types import TwoViewResult, TwoViewSettings, moved, refused

FAR_SHARES = (0.1, 0.5, 0.9)
"""Shares of what is seen that may be too far to move: the likeliest of them counts."""
SAME_HEADING_RAD = float(np.deg2rad(20.0))
"""A pose is a rival where its heading differs by more: the bar of a right answer."""
MIN_LEVEL = 0.5
"""Cosine of 60 degrees: a travel that is steeper has no heading; chosen."""
PROBABILITY = (-0.49, 1.7, -2.99, -1.23, 1.26)
"""Constant, and factors of ln(share of the score that no rival has), ln(noise), ln(spread of the heading)
and ln(disparity), all in degrees but the first. From links of photographs and, as a quarter each, equal rooms
taken for one another; a tour left out is told with an error of 0.09."""
AS_MUCH = 0.6
"""Share of the evidence of the best turn that a motion needs; chosen: turns foretell both coordinates."""
SIDEWAYS = 3
"""Row of the covariance that belongs to the travel sideways."""


@dataclass(frozen=True, eq=False)
class Motion:
    """The likeliest motion and what speaks for it.

    Attributes:
        pose: one pose.
        mask: (N,) matches that rather belong to it than not.
        score: nats of evidence, less how unlikely its tilt and climb are.
        rival: the same of the best pose with another heading, at least 0: chance.
        moving: evidence of the motion, part of the scene being far.
        parallax: nats by which this is more than that of its rotation alone.
        heading_std_rad: spread of its heading.
        noise_rad: spread of the residuals of the mask.
    """

    pose: Poses
    mask: BoolArray
    score: float
    rival: float
    moving: float
    parallax: float
    heading_std_rad: float
    noise_rad: float


def estimate_tilted(
    current: FloatArray, target: FloatArray, cues: Cues, rng: np.random.Generator, settings: TwoViewSettings
) -> TwoViewResult:
    """Heading and yaw between two views of any tilt.

    The heading is the longitude of the travel direction, the yaw that of the rotation about the vertical.

    Args:
        current: (N, 2) longitude, latitude of the matches in the current frame, radians.
        target: (N, 2) the same matches in the target frame, radians.
        cues: what is known of the matches beside.
        rng: draws the samples; the only source of chance.
        settings: limits.
    """
    none = np.zeros(len(current), dtype=np.bool_)
    if len(current) < settings.min_matches:
        return refused("too_few", none)
    matches = Bearings(bearings_from_lonlat(current).T, bearings_from_lonlat(target).T, cues.log_scale)
    motion = likeliest_motion(matches, PlanarMatches.from_lonlat(current, target), cues, rng)
    turn, mask, score = _turn(matches, cues, rng)
    if motion is not None and _beats_turn(motion, score, settings):
        return _accepted(motion, matches, settings)
    if int(mask.sum()) >= settings.min_inliers and score >= settings.min_nats:
        return _turned(turn, mask, matches)
    return refused("inconsistent", none)


def likeliest_motion(
    matches: Bearings, planar: PlanarMatches, cues: Cues, rng: np.random.Generator
) -> Motion | None:
    """The motion that explains most, and what speaks for it; None where there is no hope of any."""
    found = search(matches, planar, cues, rng)
    if found is None:
        return None
    pose = found.poses.of(np.array([0]))
    seen = evaluate(pose, matches)
    ratio = motion_ratio(seen, NOISE_RAD)[0]
    mask = belongs(cues.right, ratio)
    other = np.abs(wrap_rad(found.poses.heading_rad - found.poses.heading_rad[0])) > SAME_HEADING_RAD
    noise = float(np.sqrt(np.sum(seen.residual[0][mask] ** 2) / max(int(mask.sum()) - 5, 1)))
    level = max(float(np.hypot(*pose.travel[0, :2])), 1e-6)
    moving, still = _moving(pose, ratio, matches, cues)
    return Motion(
        pose=pose,
        mask=mask,
        score=float(found.score[0]),
        rival=max(0.0, *found.score[other].tolist()) if other.any() else 0.0,
        moving=moving,
        parallax=moving - still,
        heading_std_rad=float(np.sqrt(found.covariance[0, SIDEWAYS, SIDEWAYS])) / level,
        noise_rad=max(noise, NOISE_FLOOR_RAD),
    )


def _moving(pose: Poses, ratio: FloatArray, matches: Bearings, cues: Cues) -> tuple[float, float]:
    """Evidence of a motion, part of the scene being far, and of its rotation without travel, nats."""
    apart = _apart_rad(matches, pose.rotation[0] @ matches.target)
    far = turn_ratio(apart, matches.log_scale, NOISE_RAD)
    still = float(evidence(cues.right, far).sum())
    moving = [float(evidence(cues.right, f * far + (1.0 - f) * ratio).sum()) for f in FAR_SHARES]
    return max(moving), still


def _turn(matches: Bearings, cues: Cues, rng: np.random.Generator) -> tuple[FloatArray, BoolArray, float]:
    """Rotation (3, 3) alone that explains most, the matches that belong to it, and its evidence, nats."""
    first = cues.likeliest
    rotation, _ = fit_rotation(matches.current.T[first], matches.target.T[first], rng, NOISE_RAD)
    apart = _apart_rad(matches, rotation @ matches.target)
    ratio = turn_ratio(apart, matches.log_scale, NOISE_RAD)
    return rotation, belongs(cues.right, ratio), float(evidence(cues.right, ratio).sum())


def _beats_turn(motion: Motion, turn: float, settings: TwoViewSettings) -> bool:
    """Whether there is a way: neither its own rotation nor any other explains as much."""
    return motion.parallax >= settings.min_parallax_nats and motion.moving >= AS_MUCH * turn


def _turned(rotation: FloatArray, mask: BoolArray, matches: Bearings) -> TwoViewResult:
    apart = _apart_rad(matches, rotation @ matches.target)[mask]
    return TwoViewResult(
        status="no_baseline",
        heading_rad=None,
        yaw_rad=float(wrap_rad(yaw_of(rotation))),
        inlier_mask=mask,
        inliers=int(mask.sum()),
        confidence=0.0,
        disparity_rad=disparity_rad(apart),
        heading_std_rad=None,
        yaw_std_rad=None,
        sign_margin=0.0,
        noise_rad=None,
        model="rotation",
        moved=moved(apart),
    )


def _accepted(motion: Motion, matches: Bearings, settings: TwoViewSettings) -> TwoViewResult:
    inliers, mask, travel = int(motion.mask.sum()), motion.mask, motion.pose.travel[0]
    if inliers < settings.min_inliers or motion.score < settings.min_nats:
        return refused("inconsistent", mask)
    apart = _apart_rad(matches, motion.pose.rotation[0] @ matches.target)[mask]
    disparity = disparity_rad(apart)
    heading_std = motion.heading_std_rad / parallax_share(disparity, motion.noise_rad)
    if heading_std > settings.max_heading_std_rad or float(np.hypot(travel[0], travel[1])) < MIN_LEVEL:
        return refused("inconsistent", mask)
    return TwoViewResult(
        status="ok",
        heading_rad=float(wrap_rad(motion.pose.heading_rad[0])),
        yaw_rad=float(wrap_rad(motion.pose.yaw_rad[0])),
        inlier_mask=mask,
        inliers=inliers,
        confidence=heading_probability(motion, disparity),
        disparity_rad=disparity,
        heading_std_rad=heading_std,
        yaw_std_rad=None,
        sign_margin=1.0,
        noise_rad=motion.noise_rad,
        model="tilted",
        moved=moved(apart),
    )


def heading_probability(motion: Motion, apart_rad: float) -> float:
    """Probability that the heading is within 20 degrees: logistic regression, see PROBABILITY."""
    constant, by_margin, by_noise, by_spread, by_disparity = PROBABILITY
    margin = (motion.score - motion.rival) / max(motion.score, 1.0)
    x = constant + by_margin * np.log(max(margin, 0.0) + 0.05)
    x += by_noise * np.log(motion.noise_rad / NOISE_RAD) + by_spread * np.log(
        np.degrees(motion.heading_std_rad)
    )
    x += by_disparity * np.log(np.degrees(apart_rad) + 1.0)
    return float(1.0 / (1.0 + np.exp(-x)))


def _apart_rad(matches: Bearings, turned: FloatArray) -> FloatArray:
    """Angle (N,) between the current bearings and (3, N) turned target ones."""
    return angle_between_rad(matches.current.T, turned.T)
