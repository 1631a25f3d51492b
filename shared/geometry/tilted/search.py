"""Search for relative poses: hypotheses from level cameras and from five matches, refined."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.planar_model import PlanarMatches, line_scores, solve_pairs
from shared.geometry.sphere import FloatArray
from shared.geometry.tilted.five_point import five_point, poses_of
from shared.geometry.tilted.match_evidence import (
    Cues,
    evidence,
    in_front,
    motion_ratio,
    plane_ratio,
    unlikely,
)
from shared.geometry.tilted.poses import Bearings, Poses, evaluate, upright
from shared.geometry.tilted.refine import refine

# What half and twice of each changes is measured by tests/benchmarks/test_two_view_effort.py.
PAIRS = 600
"""Hypotheses of level cameras."""
LINES, STARTS, LEFT, RIVALS = 48, 24, 8, 5
"""Lines of travel whose signs are told apart, poses refined coarsely and finely, and on all matches."""
HOPELESS = 3.0
"""Evidence below which no pose is refined on all matches, nats: a third of what an answer needs."""
WIDE_RAD = float(np.deg2rad(2.0))
"""Threshold of the lines: cameras of 2 degrees relative tilt still come first."""
COARSE_RAD = tuple(np.deg2rad([2.0, 1.4]).tolist())
ANNEALED_RAD = tuple(np.deg2rad([1.0, 0.6, 0.45]).tolist())
FINAL_RAD = tuple(np.deg2rad([0.6, 0.45, 0.3]).tolist())
"""Noise assumed step by step, down to that of match_evidence."""
EITHER_WAY = np.array([[1.0, 1.0], [-1.0, 1.0]])
ALL_FOUR = np.array([[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]])
"""Signs, see Poses.opposite, of what a line of travel and an essential matrix stand for."""
APART_RAD, TURNED_RAD = float(np.deg2rad(8.0)), float(np.deg2rad(4.0))
"""Poses that differ by less in travel and in rotation are one."""
FIVES = 60
"""Samples of five matches; with two thirds of the sure ones right, eight of them are right."""
SURE, SURE_COUNT = 0.5, 12
"""So many matches that likely are right, and are not explained, are worth samples of five."""
EXPLAINED = 0.75
"""Share of the sure matches that an answer from level cameras must explain."""


@dataclass(frozen=True, eq=False)
class Found:
    """Poses that explain most, best first.

    Attributes:
        poses: K of them, all different.
        score: (K,) nats: evidence of all matches less how unlikely tilt and climb are.
        covariance: (K, 5, 5) of the parameters of refine.
    """

    poses: Poses
    score: FloatArray
    covariance: FloatArray


def search(matches: Bearings, planar: PlanarMatches, cues: Cues, rng: np.random.Generator) -> Found | None:
    """The best different poses; None where there is no hope of any.

    Args:
        matches: N matches.
        planar: the same, prepared for level cameras.
        cues: what is known of them.
        rng: draws the samples.
    """
    first = cues.likeliest
    near, right = matches.of(first), cues.right[first]
    starts = _level(near, planar.of(first), right, rng)
    if starts is None:
        return None
    poses = _refined(starts, near, right)
    ratio = _final_ratio(poses, near)
    if _unexplained(ratio, right):
        others = _of_five(near, right, rng)
        if others is not None:
            more = _refined(others, near, right)
            poses, ratio = _joined(poses, more), np.concatenate([ratio, _final_ratio(more, near)])
    score = _score(poses, ratio, right)
    if float(score.max()) < HOPELESS:
        return None
    kept = poses.of(np.array(_different(poses, score)))
    kept, information = refine(kept, matches, cues.right, FINAL_RAD, measured=2)
    score = _score(kept, _final_ratio(kept, matches), cues.right)
    order = np.argsort(-score, kind="stable")
    covariance = np.asarray(np.linalg.inv(information[order]), dtype=np.float64)
    return Found(kept.of(order), score[order], covariance)


def _level(
    matches: Bearings, planar: PlanarMatches, right: FloatArray, rng: np.random.Generator
) -> Poses | None:
    """Starts from pairs of matches of level cameras, drawn by how likely they are right."""
    share = right / right.sum()
    pairs = rng.choice(len(right), (PAIRS, 2), p=share)
    directions = solve_pairs(planar.rows, pairs[pairs[:, 0] != pairs[:, 1]])
    if directions.size == 0:
        return None
    lines = np.argsort(-line_scores(planar, directions, WIDE_RAD), kind="stable")[:LINES]
    heading, heading_target = directions[:, lines]
    return _starts(upright(heading, heading - heading_target), matches, right, EITHER_WAY)


def _of_five(matches: Bearings, right: FloatArray, rng: np.random.Generator) -> Poses | None:
    """Starts from samples of five of the matches that are likely right."""
    sure = np.flatnonzero(right >= SURE)
    samples = sure[np.argsort(rng.random((FIVES, len(sure))), axis=1)[:, :5]]
    essentials = five_point(matches.current.T[samples], matches.target.T[samples])
    if len(essentials) == 0:
        return None
    return _starts(poses_of(essentials), matches, right, ALL_FOUR)


def _starts(poses: Poses, matches: Bearings, right: FloatArray, signs: FloatArray) -> Poses:
    """The best of these poses and of their opposites by (S, 2) signs of way and side."""
    noise_rad = 0.5 * WIDE_RAD
    seen = evaluate(poses, matches)
    behind = evidence(right, np.zeros(len(right)))
    gain = evidence(right, plane_ratio(seen, noise_rad)) - behind
    score = [np.sum(gain * in_front(seen, noise_rad, way, side), axis=1) for way, side in signs]
    best = np.argsort(-np.concatenate(score), kind="stable")[:STARTS]
    sign, pose = np.divmod(best, len(poses))
    return poses.of(pose).opposite(*signs[sign].T)


def _refined(starts: Poses, matches: Bearings, right: FloatArray) -> Poses:
    poses, _ = refine(starts, matches, right, COARSE_RAD)
    poses, _ = refine(_best(poses, matches, right, COARSE_RAD[-1], LEFT), matches, right, ANNEALED_RAD)
    return poses


def _best(poses: Poses, matches: Bearings, right: FloatArray, noise_rad: float, count: int) -> Poses:
    """The poses with the most evidence, most first, the noise being so large."""
    ratio = motion_ratio(evaluate(poses, matches), noise_rad)
    return poses.of(np.argsort(-evidence(right, ratio).sum(axis=1), kind="stable")[:count])


def _final_ratio(poses: Poses, matches: Bearings) -> FloatArray:
    return motion_ratio(evaluate(poses, matches), FINAL_RAD[-1])


def _score(poses: Poses, ratio: FloatArray, right: FloatArray) -> FloatArray:
    return np.asarray(evidence(right, ratio).sum(axis=1) - unlikely(poses), dtype=np.float64)


def _unexplained(ratio: FloatArray, right: FloatArray) -> bool:
    """Whether many likely matches fit no pose so far: the cameras may lean far from each other."""
    sure = right >= SURE
    if sure.sum() < SURE_COUNT:
        return False
    return bool((ratio[:, sure] > 1.0).mean(axis=1).max() < EXPLAINED)


def _different(poses: Poses, score: FloatArray) -> list[int]:
    """Indices of the best poses that differ from each other."""
    rotation = poses.rotation.reshape(len(poses), 9)
    turn = (rotation @ rotation.T - 1.0) / 2.0  # cosines
    same = (poses.travel @ poses.travel.T > np.cos(APART_RAD)) & (turn > np.cos(TURNED_RAD))
    kept: list[int] = []
    for k in np.argsort(-score, kind="stable").tolist():
        if not same[k, kept].any():
            kept.append(k)
        if len(kept) == RIVALS:
            break
    return kept


def _joined(a: Poses, b: Poses) -> Poses:
    return Poses(np.concatenate([a.rotation, b.rotation]), np.concatenate([a.travel, b.travel]))
