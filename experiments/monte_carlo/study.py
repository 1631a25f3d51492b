"""The parts of `topnav study heading`, each from plans to figures."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from experiments.monte_carlo.ahae import COUNTS, METHODS, AhaePlan, Statistics, scene_errors
from experiments.monte_carlo.noise import ALL_METHODS, NoisePlan, epipolar_paths, noisy_errors
from experiments.monte_carlo.scene import PLACEMENTS, Placement
from experiments.monte_carlo.sweep import FUNCTIONS, WEIGHTED, SweepPlan, scene_sweep
from experiments.monte_carlo.tracking import DcpePlan, scene_paths
from shared.geometry.sphere import FloatArray

NOISES_DEG = (0.0, 0.25, 0.5, 1.0)
"""The grid of the study: from none to three pixels of a panorama 1024 wide (0.35 degrees each)."""

OUTLIERS = (0.0, 0.2, 0.4)
"""The grid of the study: none, one match in five, two in five."""

Rows = list[dict[str, Any]]
Worker = Callable[[Callable[[Any], FloatArray], Sequence[Any]], list[FloatArray]]
"""Gives function and plans to whoever works, and their results back."""


@dataclass(frozen=True)
class Size:
    """How much is drawn."""

    scenes: int
    ahae_runs: int
    dcpe_scenes: int
    dcpe_runs: int
    noise_scenes: int
    noise_runs: int
    sweep_scenes: int
    counts: tuple[int, ...] = COUNTS


QUICK = Size(8, 200, 4, 4, 6, 2, 3, counts=(5, 13, 34, 60))
"""Less than a minute on two cores, as --quick promises."""

NORMAL = Size(100, 500, 30, 10, 25, 4, 12)
FULL = Size(100, 2000, 100, 2000, 100, 10, 40)
"""The thesis's: 100 scenes of 2000 runs (section 3.2.1)."""


def ahae(size: Size, seed: int, work: Worker, gain_per_rad: float) -> dict[Placement, Statistics]:
    """Absolute heading angle errors by placement, degrees."""
    plans = [
        AhaePlan(p, s, seed, size.ahae_runs, size.counts, gain_per_rad)
        for p in PLACEMENTS
        for s in range(size.scenes)
    ]
    found = np.array(work(scene_errors, plans)).reshape(len(PLACEMENTS), size.scenes, 2, len(METHODS), -1)
    return {p: Statistics(size.counts, found[k, :, 0], found[k, :, 1]) for k, p in enumerate(PLACEMENTS)}


def dcpe(
    size: Size, seed: int, work: Worker, gain_per_rad: float, device: str
) -> dict[Placement, Statistics]:
    """Distance covered percent errors by placement, percent."""
    plans = [
        DcpePlan(p, s, seed, size.dcpe_runs, n, gain_per_rad, device)
        for p in PLACEMENTS
        for s in range(size.dcpe_scenes)
        for n in size.counts
    ]
    shape = (len(PLACEMENTS), size.dcpe_scenes, len(size.counts), len(METHODS), size.dcpe_runs)
    found = np.array(work(scene_paths, plans)).reshape(shape).swapaxes(2, 3)
    return {
        p: Statistics(size.counts, found[k].mean(axis=-1), found[k].std(axis=-1))
        for k, p in enumerate(PLACEMENTS)
    }


def noise(size: Size, seed: int, work: Worker) -> tuple[Rows, Rows]:
    """Errors of all methods under noise and outliers, and the paths of the epipolar direction."""
    conditions = [(sigma, share) for sigma in NOISES_DEG for share in OUTLIERS]
    plans = [
        NoisePlan(p, s, seed, size.noise_runs, noise_deg=sigma, outliers=share)
        for p in PLACEMENTS
        for sigma, share in conditions
        for s in range(size.noise_scenes)
    ]
    errors = np.array(work(noisy_errors, plans))
    errors = errors.reshape(len(PLACEMENTS), len(conditions), size.noise_scenes, len(ALL_METHODS), -1)
    rows = [
        {
            "method": method,
            "placement": placement,
            "keypoints": 60,
            "noise_deg": sigma,
            "outliers": share,
            "mean_deg": round(float(errors[k, c, :, m].mean()), 3),
            "median_deg": round(float(np.median(errors[k, c, :, m])), 3),
        }
        for k, placement in enumerate(PLACEMENTS)
        for c, (sigma, share) in enumerate(conditions)
        for m, method in enumerate(ALL_METHODS)
    ]
    walked = [NoisePlan(p, s, seed, 2) for p in PLACEMENTS for s in range(size.noise_scenes)]
    covered = np.array(work(epipolar_paths, walked)).reshape(len(PLACEMENTS), -1)
    paths = [
        {
            "method": "epipolar",
            "placement": placement,
            "keypoints": 60,
            "noise_deg": walked[0].noise_deg,
            "outliers": walked[0].outliers,
            "mean_pct": round(float(covered[k].mean()), 3),
            "std_pct": round(float(covered[k].std()), 3),
        }
        for k, placement in enumerate(PLACEMENTS)
    ]
    return rows, paths


def sweep(size: Size, seed: int, work: Worker) -> Rows:
    """Mean errors of methods 2, 4, 5 and 6 with every priority function."""
    plans = [SweepPlan(p, s, seed, 10) for p in PLACEMENTS for s in range(size.sweep_scenes)]
    found = np.array(work(scene_sweep, plans)).reshape(len(PLACEMENTS), size.sweep_scenes, len(FUNCTIONS), -1)
    return [
        {"priority": name, "placement": p}
        | {f"method_{m}_deg": round(float(found[k, :, f, c].mean()), 2) for c, m in enumerate(WEIGHTED)}
        for k, p in enumerate(PLACEMENTS)
        for f, name in enumerate(FUNCTIONS)
    ]
