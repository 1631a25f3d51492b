"""Headings by all seven methods from the same matches of pairs of frames.

Uses the pure code of `services.features` (matching, verification limits) and `services.planner.heading`.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from experiments.rendered.features import Tick, cache_folder, kept_features
from experiments.rendered.pairs import APART_M, PosePair, draw_pairs
from services.features.matching.verification import cues_of
from services.features.pipeline.interfaces import FeatureSet
from services.features.pipeline.pipeline import Pipeline
from services.planner.heading.methods import heading_estimate
from shared.geometry.two_view import TwoViewResult, two_view
from simulator.disturbances.levels import generator
from simulator.disturbances.rocking import drawn
from simulator.sensors.attitude import PitchRoll
from simulator.world.freespace import free_space
from simulator.world.world_file import WorldFile

METHODS = ("epipolar", "1", "2", "3", "4", "5", "6")


@dataclass(frozen=True)
class PairResult:
    """One pair.

    Attributes:
        raw, verified: number of matches before and after verification.
        disparity_rad: change of bearings after yaw; None where there is no yaw.
        verified_errors_rad: heading error by method, from verified matches; None where it gave no heading.
        raw_errors_rad: the same from all matches; epipolar is the same in both.
        yaw_error_rad: None where there is no yaw.
        is_free: a robot can drive straight from one to the other.
    """

    distance_m: float
    raw: int
    verified: int
    status: str
    confidence: float
    disparity_rad: float | None
    yaw_error_rad: float | None
    verified_errors_rad: dict[str, float | None]
    raw_errors_rad: dict[str, float | None]
    is_free: bool = True


def measure(
    world: WorldFile,
    pipeline: Pipeline,
    count: int,
    seed: int,
    data_dir: Path,
    tick: Tick,
    apart_m: tuple[float, float] = APART_M,
    rocking_rad: float = 0.0,
) -> list[PairResult]:
    """Draw pairs, render what is not kept in `data_dir` yet, and judge every method on each.

    `rocking_rad` is 1 sigma of the pitch and of the roll of every frame; the pairs are the same without it.
    """
    pairs = draw_pairs(free_space(world), count, np.random.default_rng(seed), apart_m)
    tilts = draw_tilts(2 * count, rocking_rad, seed)
    choices = (seed, apart_m, f"rocking {rocking_rad}") if tilts else (seed, apart_m)
    folder = cache_folder(data_dir / "cache", "pairs", world, pipeline, *choices)
    return judge_pairs(pairs, world, pipeline, folder, tick, tilts)


def draw_tilts(frames: int, sigma_rad: float, seed: int) -> list[PitchRoll]:
    """A tilt for each of a number of frames, the first ones the same for any number; none if sigma is 0."""
    if sigma_rad == 0.0:
        return []
    rng = generator(seed, "frames that rock")
    return [drawn(sigma_rad, rng) for _ in range(frames)]


def judge_pairs(
    pairs: Sequence[PosePair],
    world: WorldFile,
    pipeline: Pipeline,
    folder: Path,
    tick: Tick,
    tilts: Sequence[PitchRoll] = (),
) -> list[PairResult]:
    """Judge every method on each pair; features are kept in `folder`, `tick` hears how far it is."""
    poses = [pose for pair in pairs for pose in (pair.current, pair.target)]
    seen = kept_features(world, pipeline, poses, folder, tick, tilts)
    results = []
    for number, (pair, *both) in enumerate(zip(pairs, seen[::2], seen[1::2], strict=True)):
        tick(f"headings of pair {number + 1} of {len(pairs)}")
        results.append(judge_pair(pair, both[0], both[1], pipeline, number))
    return results


def judge_pair(
    pair: PosePair, here: FeatureSet, there: FeatureSet, pipeline: Pipeline, seed: int
) -> PairResult:
    """Match, verify, and compare every method's heading with the truth; `seed` draws the hypotheses. Pure."""
    (matched,) = pipeline.matcher.match(here, [there])
    rows = matched.pairs
    current, target = here.lonlat_rad[rows[:, 0]], there.lonlat_rad[rows[:, 1]]
    cues = cues_of(here, there, matched)
    result = two_view(current, target, np.random.default_rng(seed), pipeline.verification, cues)
    kept = result.inlier_mask
    return PairResult(
        distance_m=pair.distance_m,
        raw=matched.count(),
        verified=matched.count(kept),
        status=result.status,
        confidence=result.confidence,
        disparity_rad=result.disparity_rad,
        yaw_error_rad=_error(result.yaw_rad, pair.yaw_rad),
        verified_errors_rad=_errors(pair, current[kept], target[kept], result),
        raw_errors_rad=_errors(pair, current, target, result),
        is_free=pair.is_free,
    )


def _errors(
    pair: PosePair, current: np.ndarray, target: np.ndarray, result: TwoViewResult
) -> dict[str, float | None]:
    headings = {name: heading_estimate(name, current, target).heading_rad for name in METHODS[1:]}
    headings["epipolar"] = result.heading_rad if result.usable else None
    return {name: _error(heading, pair.heading_rad) for name, heading in headings.items()}


def _error(estimate_rad: float | None, true_rad: float) -> float | None:
    return (
        None
        if estimate_rad is None
        else abs(float(np.remainder(estimate_rad - true_rad + np.pi, 2 * np.pi) - np.pi))
    )
