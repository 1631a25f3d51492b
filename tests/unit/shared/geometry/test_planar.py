"""Planar two-view RANSAC: exact cases, accuracy under noise and outliers, refusals, determinism."""

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from shared.geometry import planar_fit
from shared.geometry.evidence import quantile
from shared.geometry.planar import estimate_planar
from shared.geometry.planar_fit import leverage_weights
from shared.geometry.planar_model import PlanarMatches, evaluate, solve_pairs
from shared.geometry.planar_refine import _linearise
from shared.geometry.sphere import lonlat_from_bearings
from shared.geometry.two_view_types import TwoViewSettings
from tests.unit.shared.geometry.synthetic_room import error_deg, make_scene

LIMITS = TwoViewSettings()


def run(scene, seed=0, limits=LIMITS):
    return estimate_planar(scene.current, scene.target, np.random.default_rng(seed), limits)


def run_many(repeats, seed=0, **scene):
    rng = np.random.default_rng(seed)
    scenes = [make_scene(rng, **scene) for _ in range(repeats)]
    return [(s, run(s, k)) for k, s in enumerate(scenes)]


def heading_errors(pairs):
    return np.array([error_deg(r.heading_rad, s.heading_rad) for s, r in pairs if r.usable])


def hand_made(heading, yaw):
    """Eight points around the camera, which moves 1 m, as (current, target); not by the code under test."""
    angles = np.deg2rad([10.0, 55.0, 100.0, 145.0, 190.0, 235.0, 280.0, 325.0])
    points = np.stack([3 * np.cos(angles), 3 * np.sin(angles), [1, -1, 1.5, -0.8, 1.2, -1, 0.7, -1]], axis=1)
    moved = points - [np.cos(heading), np.sin(heading), 0.0]
    c, s = np.cos(yaw), np.sin(yaw)
    target = np.stack(
        [moved[:, 0] * c + moved[:, 1] * s, -moved[:, 0] * s + moved[:, 1] * c, moved[:, 2]], axis=1
    )
    return lonlat_from_bearings(points), lonlat_from_bearings(target)


@pytest.mark.parametrize("heading", np.deg2rad([0.0, 30.0, 90.0, 179.9, -90.0, -135.0]))
@pytest.mark.parametrize("yaw", np.deg2rad([0.0, 20.0, 180.0, -90.0]))
def test_noiseless_scene_gives_the_exact_heading_sign_and_yaw(heading, yaw):
    current, target = hand_made(heading, yaw)
    result = estimate_planar(current, target, np.random.default_rng(0), LIMITS)
    assert result.status == "ok"
    assert error_deg(result.heading_rad, heading) < 1e-6
    assert error_deg(result.yaw_rad, yaw) < 1e-6
    assert result.inliers == 8
    assert result.sign_margin > 0.99


def test_two_matches_contain_the_true_motion_among_their_solutions():
    current, target = hand_made(0.7, -0.4)
    rows = PlanarMatches.from_lonlat(current, target).rows
    phi, phi_target = solve_pairs(rows, np.array([[0, 3]]))
    residue = np.minimum(np.abs(np.sin(phi - 0.7)) + np.abs(np.sin(phi_target - 1.1)), 9.0)
    assert residue.min() < 1e-9


@pytest.mark.parametrize(
    ("from_travel_deg", "forward", "backward"),
    [
        pytest.param((40.0, 50.0), True, False, id="moves away from the travel direction: in front for +t"),
        pytest.param((50.0, 40.0), False, True, id="moves towards it: in front for -t"),
        pytest.param((40.0, -50.0), False, False, id="changes sides: in front for neither"),
    ],
)
def test_point_in_the_epipolar_plane_must_lie_in_front(from_travel_deg, forward, backward):
    travel, up = np.array([1.0, 0.0, 0.0]), np.array([0.0, np.cos(0.6), np.sin(0.6)])
    rays = [np.cos(a) * travel + np.sin(a) * up for a in np.deg2rad(from_travel_deg)]
    matches = PlanarMatches.from_lonlat(*(lonlat_from_bearings(ray)[None] for ray in rays))
    result = evaluate(matches, np.zeros((2, 1)))
    plus, minus = result.consistent(LIMITS.threshold_rad)
    assert abs(result.residual[0, 0]) < 1e-12
    assert (plus[0, 0], minus[0, 0]) == (forward, backward)


def test_matches_on_the_horizon_give_no_hypothesis():
    flat = np.stack([np.linspace(-3, 3, 10), np.zeros(10)], axis=1)
    directions = solve_pairs(PlanarMatches.from_lonlat(flat, flat).rows, np.array([[0, 1], [2, 3]]))
    assert directions.shape == (2, 0)
    assert estimate_planar(flat, flat, np.random.default_rng(0), LIMITS).status == "inconsistent"


def test_derivative_agrees_with_finite_differences():
    scene = make_scene(np.random.default_rng(2), 20)
    matches = PlanarMatches.from_lonlat(scene.current, scene.target)

    def residual(a, b):
        return evaluate(matches, np.array([[a], [b]])).residual[0]

    _, jacobian, _ = _linearise(matches, np.array([[0.3], [1.1]]), 0.1, np.array([0.1]))
    h = 1e-6
    by_phi = (residual(0.3 + h, 1.1) - residual(0.3 - h, 1.1)) / (2 * h)
    by_target = (residual(0.3, 1.1 + h) - residual(0.3, 1.1 - h)) / (2 * h)
    np.testing.assert_allclose(jacobian[:, 0], [by_phi, by_target], atol=1e-8)


@pytest.mark.parametrize(
    ("count", "outliers"),
    [
        pytest.param(60, 36, id="60 with 36 wrong"),
        pytest.param(150, 90, id="150 with 90 wrong"),
        pytest.param(60, 0, id="60 right"),
    ],
)
@pytest.mark.parametrize("distance_m", [0.5, 1.0, 2.5])
def test_median_heading_error_is_within_a_degree(count, outliers, distance_m):
    pairs = run_many(40, seed=count + outliers, count=count, outliers=outliers, distance_m=distance_m)
    assert all(r.usable for _, r in pairs)
    errors = heading_errors(pairs)
    assert np.median(errors) <= 1.0
    assert errors.max() < 12.0
    assert np.median([error_deg(r.yaw_rad, s.yaw_rad) for s, r in pairs]) < 0.5


def test_inliers_are_the_right_matches():
    for scene, result in run_many(20, count=60, outliers=36, noise_deg=0.1):
        assert result.inlier_mask[scene.correct].mean() > 0.9
        assert result.inlier_mask[~scene.correct].mean() < 0.25


def test_displacement_far_above_the_lower_quartile_loses_its_influence():
    weights = leverage_weights(np.deg2rad([1.0, 1.0, 1.0, 6.0, 60.0]))
    np.testing.assert_allclose(weights, [36 / 37, 36 / 37, 36 / 37, 0.5, 1 / 101], rtol=1e-9)


def test_short_baseline_survives_wrong_matches_that_lie_near_the_plane():
    errors = heading_errors(run_many(40, count=60, outliers=30, distance_m=0.1, noise_deg=0.1))
    assert len(errors) >= 38
    assert np.median(errors) < 2.5
    assert np.quantile(errors, 0.9) < 8.0


def test_disparity_is_the_median_angle_after_the_yaw():
    scene = make_scene(np.random.default_rng(4), 60, distance_m=1.0, noise_deg=0.0)
    result = run(scene)
    c, t = scene.current, scene.target
    dot = np.sin(c[:, 1]) * np.sin(t[:, 1])
    dot += np.cos(c[:, 1]) * np.cos(t[:, 1]) * np.cos(c[:, 0] - t[:, 0] - scene.yaw_rad)
    assert result.disparity_rad == pytest.approx(np.median(np.arccos(np.clip(dot, -1, 1))), abs=1e-4)


def test_stated_spread_matches_the_errors():
    pairs = run_many(60, count=60, outliers=24, distance_m=0.5)
    z = heading_errors(pairs) / np.rad2deg([r.heading_std_rad for _, r in pairs])
    assert 0.4 < np.quantile(z, 0.68) < 2.0


@pytest.mark.parametrize(("count", "outliers"), [(60, 0), (60, 36), (24, 0)])
def test_turning_on_the_spot_is_refused_but_its_yaw_is_told(count, outliers):
    pairs = run_many(60, count=count, outliers=outliers, distance_m=0.0)
    refused = [(s, r) for s, r in pairs if r.status == "no_baseline"]
    assert len(refused) >= 58
    assert all(r.heading_rad is None and r.confidence == 0.0 for _, r in refused)
    assert max(error_deg(r.yaw_rad, s.yaw_rad) for s, r in refused) < 1.5
    assert max(r.disparity_rad for _, r in refused) < np.deg2rad(1.0)


def test_identical_frames_are_refused():
    scene = make_scene(np.random.default_rng(1), 60)
    result = estimate_planar(scene.current, scene.current, np.random.default_rng(0), LIMITS)
    assert (result.status, result.inliers) == ("no_baseline", 60)
    assert abs(result.yaw_rad) < 1e-9


@pytest.mark.parametrize("count", [0, 1, 5])
def test_too_few_matches_are_refused(count):
    result = estimate_planar(np.zeros((count, 2)), np.zeros((count, 2)), np.random.default_rng(0), LIMITS)
    assert (result.status, result.heading_rad, result.inlier_mask.shape) == ("too_few", None, (count,))


def test_wrong_matches_alone_are_inconsistent():
    statuses = [r.status for _, r in run_many(40, count=60, outliers=60)]
    assert statuses.count("inconsistent") >= 39


def test_confidence_falls_with_the_baseline_and_with_wrong_matches():
    def median(**scene):
        return np.median([r.confidence for _, r in run_many(25, **scene)])

    assert median(count=60) > median(count=60, outliers=40) > median(count=60, outliers=46, distance_m=0.2)


def test_same_generator_state_gives_the_same_answer():
    scene = make_scene(np.random.default_rng(9), 80, 40)
    a, b = run(scene, seed=5), run(scene, seed=5)
    assert (a.heading_rad, a.yaw_rad, a.confidence) == (b.heading_rad, b.yaw_rad, b.confidence)
    np.testing.assert_array_equal(a.inlier_mask, b.inlier_mask)


def test_turning_the_target_changes_the_yaw_and_nothing_else():
    scene = make_scene(np.random.default_rng(3), 60, 20)
    turned = scene.target + np.array([1.234, 0.0])
    a = run(scene)
    b = estimate_planar(scene.current, turned, np.random.default_rng(0), LIMITS)
    assert error_deg(a.heading_rad, b.heading_rad) < 1e-3
    assert error_deg(a.yaw_rad - 1.234, b.yaw_rad) < 1e-3


def test_swapping_the_frames_turns_the_heading_round():
    scene = make_scene(np.random.default_rng(3), 60, 0)
    there = run(scene)
    back = estimate_planar(scene.target, scene.current, np.random.default_rng(0), LIMITS)
    assert error_deg(back.yaw_rad, -there.yaw_rad) < 0.05
    assert error_deg(back.heading_rad, there.heading_rad + np.pi - there.yaw_rad) < 0.05


LONLAT = st.integers(0, 40).flatmap(
    lambda n: st.tuples(*[arrays(np.float64, (n, 2), elements=st.floats(-1.5, 1.5, width=16))] * 2)
)


@settings(max_examples=60, deadline=None)
@given(LONLAT)
def test_any_finite_input_gives_a_well_formed_result(matches):
    result = estimate_planar(*matches, np.random.default_rng(0), LIMITS)
    assert result.inliers == result.inlier_mask.sum()
    assert 0.0 <= result.confidence <= 1.0
    assert (result.heading_rad is None) == (result.status != "ok")
    for value in (result.heading_rad, result.yaw_rad, result.disparity_rad, result.heading_std_rad):
        assert value is None or np.isfinite(value)


@pytest.mark.parametrize(
    ("current", "target", "message"),
    [
        (np.zeros((5, 2)), np.zeros((6, 2)), r"shape \(N, 2\), got \(5, 2\) and \(6, 2\)"),
        (np.zeros((5, 3)), np.zeros((5, 3)), r"shape \(N, 2\)"),
        (np.full((9, 2), np.nan), np.zeros((9, 2)), "finite"),
    ],
)
def test_malformed_input_is_named(current, target, message):
    with pytest.raises(ValueError, match=message):
        estimate_planar(current, target, np.random.default_rng(0), LIMITS)


def test_time_of_one_estimation_is_reported(record_property):
    scene = make_scene(np.random.default_rng(0), 120, 72)
    times = []
    for seed in range(30):
        begin = time.perf_counter()
        run(scene, seed)
        times.append(time.perf_counter() - begin)
    record_property("planar_ms_median", 1e3 * float(np.median(times)))


FLAT = TwoViewSettings(tilting=False)
"""Without a fallback that wants to know how near the best model came, hopeless ones are not refined."""


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param({"count": 60, "outliers": 36}, id="60 with 36 wrong"),
        pytest.param({"count": 20, "outliers": 8, "noise_deg": 0.3}, id="20 with 8 wrong"),
        pytest.param({"count": 12, "outliers": 3}, id="12 with 3 wrong"),
        pytest.param({"count": 20, "outliers": 20}, id="all wrong"),
    ],
)
def test_giving_hopeless_matches_up_early_changes_no_answer(scene):
    rng = np.random.default_rng(5)
    for made in [make_scene(rng, **scene) for _ in range(40)]:
        early, late = run(made, 0, FLAT), run(made, 0, LIMITS)
        assert early.status == late.status
        if early.usable:
            assert (early.heading_rad, early.inliers) == (late.heading_rad, late.inliers)


def test_hopeless_matches_are_not_refined(monkeypatch):
    refined = []
    refine = planar_fit.refine
    monkeypatch.setattr(planar_fit, "refine", lambda *given: refined.append(1) or refine(*given))
    rng = np.random.default_rng(3)
    wrong = [make_scene(rng, count=17, outliers=17) for _ in range(50)]
    right = [make_scene(rng, count=30, outliers=10) for _ in range(50)]
    for scene in wrong:
        run(scene, 0, FLAT)
    after_wrong = len(refined)
    assert after_wrong <= 10
    for scene in right:
        assert run(scene, 0, FLAT).usable
    assert len(refined) - after_wrong == 50


@pytest.mark.parametrize("share", [0.25, 0.8])
@pytest.mark.parametrize("count", [1, 2, 3, 6, 17, 100])
def test_a_quantile_is_that_of_numpy(share, count):
    values = np.random.default_rng(count).normal(size=count)
    assert quantile(values, share) == pytest.approx(np.quantile(values, share), rel=1e-12)
