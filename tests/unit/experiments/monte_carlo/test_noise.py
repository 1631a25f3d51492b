"""Noise, wrong matches, priority functions, claims, and work that goes on where it was cut off."""

import numpy as np
import pytest
from rich.console import Console

from experiments.monte_carlo.ahae import Statistics
from experiments.monte_carlo.claims import CLAIMS, judged
from experiments.monte_carlo.noise import ALL_METHODS, NoisePlan, epipolar_paths, noisy_errors, with_outliers
from experiments.monte_carlo.sweep import FUNCTIONS, WEIGHTED, SweepPlan, scene_sweep
from experiments.work.workers import results_of


def test_the_epipolar_direction_stands_what_the_other_methods_do_not():
    plans = [NoisePlan("north_east", scene, 1, 3) for scene in range(4)]
    errors = np.concatenate([noisy_errors(plan) for plan in plans], axis=1).mean(axis=1)
    best = errors[: len(ALL_METHODS) - 1].min()
    assert errors[-1] < best / 3.0


def test_without_noise_the_epipolar_direction_is_exact():
    plan = NoisePlan("north", 2, 1, 2, noise_deg=0.0, outliers=0.0)
    assert noisy_errors(plan)[-1].max() < 0.01
    assert epipolar_paths(plan).max() < 0.1


def test_exactly_the_share_of_matches_is_wrong():
    plan = NoisePlan("centre", 0, 1, 1, outliers=0.2)
    target = np.random.default_rng(1).normal(size=(60, 2))
    mixed = with_outliers(target, plan, np.random.default_rng(2))
    assert (mixed != target).any(axis=1).sum() == 12
    assert sorted(map(tuple, mixed)) == sorted(map(tuple, target))


def test_every_priority_function_is_measured():
    found = scene_sweep(SweepPlan("centre", 0, 1, runs=2, count=20))
    assert found.shape == (len(FUNCTIONS), len(WEIGHTED))
    assert np.isfinite(found).all()


def test_statistics_average_over_scenes_and_find_means_outside_the_box():
    means = np.ones((8, 6, 2))
    means[0, 1] = 100.0
    s = Statistics((5, 34), means, 2.0 * means)
    assert s.mean_of_means()["1"] == 1.0
    assert s.std_of_means()["1"] == 0.0
    assert s.mean_outside_box("2") == (5, 34)
    assert s.mean_outside_box("1") == ()
    assert s.mean_of_stds([34])["2"] == pytest.approx(2.0 * 107 / 8)


def test_every_claim_is_judged_on_figures():
    counts = (5, 8, 13, 34, 60)
    values = np.random.default_rng(1).uniform(1.0, 20.0, (10, 6, len(counts)))
    figures = {p: Statistics(counts, values, values / 2.0) for p in ("centre", "north", "north_east")}
    verdicts = judged(CLAIMS, {"ahae": figures, "dcpe": figures})
    assert {verdict["row"] for verdict in verdicts} == {32, 33, 34, 37, 38, 39}
    assert all(isinstance(verdict["holds"], bool) and verdict["evidence"] for verdict in verdicts)


def test_work_that_is_done_is_not_done_again(tmp_path):
    plans = [NoisePlan("centre", scene, 1, 1, count=12) for scene in range(2)]
    console = Console(quiet=True)
    first = results_of(noisy_errors, plans, tmp_path, console, jobs=1)
    kept = sorted(tmp_path.glob("*.npy"))
    assert len(kept) == 2
    np.save(kept[0], np.full((7, 1), 7.0))
    again = results_of(noisy_errors, plans, tmp_path, console, jobs=1)
    assert sum(np.array_equal(a, np.full((7, 1), 7.0)) for a in again) == 1
    assert len(first) == len(again) == 2
