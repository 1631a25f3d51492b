"""Planar model first, essential matrix on uneven ground, and the five-point solver under it."""

import dataclasses

import numpy as np
import pytest
from shared.geometry.essential import estimate_essential
from shared.geometry.essential_model import Pose, draw_fives, evaluate_pose, five_point, poses_of

from shared.geometry.perspective import rotation_y, rotation_z
from shared.geometry.rotation import fit_rotation
from shared.geometry.sphere import bearings_from_lonlat, lonlat_from_bearings
from shared.geometry.two_view import TwoViewSettings, two_view
from tests.unit.shared.geometry.synthetic_room import error_deg, make_scene, rotation_x

LIMITS = TwoViewSettings()
ALWAYS = TwoViewSettings(fallback_probe=0.0)
ROTATION = rotation_z(0.8) @ rotation_y(0.2) @ rotation_x(-0.1)
TRAVEL = np.array([0.6, 0.7, 0.3]) / np.linalg.norm([0.6, 0.7, 0.3])


def exact_bearings(count=5):
    points = np.random.default_rng(5).uniform(-4, 4, (count, 3))
    target = (points - TRAVEL) @ ROTATION
    return (v / np.linalg.norm(v, axis=1, keepdims=True) for v in (points, target))


def test_five_exact_matches_contain_the_true_essential_matrix():
    current, target = exact_bearings()
    x, y, z = TRAVEL
    truth = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ ROTATION
    truth /= np.linalg.norm(truth)
    found = five_point(current[None], target[None])
    assert 1 <= len(found) <= 10
    assert min(min(np.abs(e - truth).max(), np.abs(e + truth).max()) for e in found) < 1e-7


def test_one_of_the_four_poses_is_in_front_of_both_cameras():
    current, target = exact_bearings(40)
    x, y, z = TRAVEL
    poses = poses_of(np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ ROTATION)
    shares = [evaluate_pose(p, current, target).consistent(1e-6).mean() for p in poses]
    best = poses[int(np.argmax(shares))]
    assert sorted(shares)[-1] == 1.0
    assert sorted(shares)[-2] < 0.5
    np.testing.assert_allclose(best.travel, TRAVEL, atol=1e-9)
    np.testing.assert_allclose(best.rotation, ROTATION, atol=1e-9)
    assert np.abs(evaluate_pose(Pose(ROTATION, TRAVEL), current, target).residual).max() < 1e-12


def test_samples_of_five_hold_different_matches():
    drawn = draw_fives(7, 50, np.random.default_rng(0))
    assert all(len(set(row)) == 5 for row in drawn.tolist())


def test_general_rotation_is_found_among_wrong_matches():
    current, _ = exact_bearings(60)
    target = current @ ROTATION
    target[:25] = target[:25][::-1]
    rotation, mask = fit_rotation(current, target, np.random.default_rng(0), LIMITS.threshold_rad)
    np.testing.assert_allclose(rotation, ROTATION, atol=1e-9)
    assert mask[25:].all()


@pytest.mark.parametrize("tilt_deg", [3.0, 8.0, 15.0])
def test_tilted_camera_is_answered_by_the_general_model(tilt_deg):
    rng = np.random.default_rng(11)
    errors = []
    for k in range(12):
        scene = make_scene(rng, 80, 30, noise_deg=0.15, tilt_deg=tilt_deg)
        result = two_view(scene.current, scene.target, np.random.default_rng(k), ALWAYS)
        assert result.usable
        errors.append(error_deg(result.heading_rad, scene.heading_rad))
    assert np.median(errors) < 0.6
    assert np.quantile(errors, 0.8) < 2.0


def test_flat_floor_is_answered_by_the_planar_model():
    rng = np.random.default_rng(12)
    for k in range(15):
        scene = make_scene(rng, 60, 30, noise_deg=0.15)
        result = two_view(scene.current, scene.target, np.random.default_rng(k))
        assert (result.status, result.model) == ("ok", "planar")


def test_small_tilt_is_noticed_and_wrong_matches_alone_do_not_start_the_costly_model(monkeypatch):
    asked = []

    def count(current, target, rng, limits):
        asked.append(1)
        return estimate_essential(current, target, rng, limits)

    monkeypatch.setattr("shared.geometry.two_view.estimate_essential", count)
    rng = np.random.default_rng(16)
    for k in range(12):
        scene = make_scene(rng, 60, 30, noise_deg=0.15, tilt_deg=3.0)
        two_view(scene.current, scene.target, np.random.default_rng(k))
    assert len(asked) >= 10
    asked.clear()
    for k in range(20):
        scene = make_scene(rng, 60, 60)
        two_view(scene.current, scene.target, np.random.default_rng(k))
    assert len(asked) <= 4


def test_without_fallback_the_planar_answer_stands():
    scene = make_scene(np.random.default_rng(11), 80, 40, noise_deg=0.15, tilt_deg=10.0)
    limits = dataclasses.replace(LIMITS, tilting=False)
    assert two_view(scene.current, scene.target, np.random.default_rng(0), limits).model != "essential"


def test_essential_matrix_alone_reaches_a_degree():
    rng, errors = np.random.default_rng(13), []
    for k in range(12):
        scene = make_scene(rng, 60, 30)
        result = estimate_essential(scene.current, scene.target, np.random.default_rng(k), LIMITS)
        errors.append(error_deg(result.heading_rad, scene.heading_rad))
    assert np.median(errors) <= 1.0


def test_turning_on_the_spot_with_tilt_has_no_baseline():
    rng, statuses = np.random.default_rng(14), []
    for k in range(12):
        scene = make_scene(rng, 60, 10, distance_m=0.0, tilt_deg=6.0, noise_deg=0.15)
        statuses.append(two_view(scene.current, scene.target, np.random.default_rng(k), ALWAYS).status)
    assert statuses.count("no_baseline") >= 11


def test_wrong_matches_alone_are_refused_by_both_models():
    rng = np.random.default_rng(15)
    results = []
    for k in range(12):
        scene = make_scene(rng, 60, 60)
        results.append(two_view(scene.current, scene.target, np.random.default_rng(k), ALWAYS))
    assert sum(r.usable for r in results) == 0


def test_same_bearings_everywhere_raise_nothing():
    one = np.tile([[0.3, 0.2]], (40, 1))
    assert two_view(one, one, np.random.default_rng(0)).status in ("no_baseline", "inconsistent")
    b = bearings_from_lonlat(one)
    assert five_point(b[None, :5], b[None, :5]).shape[1:] == (3, 3)


def test_following_the_heading_step_by_step_reaches_the_goal():
    rng = np.random.default_rng(6)
    points = rng.uniform([-4, -4, -1], [4, 4, 1.6], (80, 3))
    points = points[np.hypot(points[:, 0], points[:, 1]) > 2.0]
    goal, position, yaw = np.array([1.0, 0.6, 0.0]), np.array([-0.9, -0.5, 0.0]), 0.4

    def seen(place, turned_rad):
        return lonlat_from_bearings((points - place) @ rotation_z(turned_rad))

    for _ in range(60):
        result = two_view(seen(position, yaw), seen(goal, -2.0), rng)
        if not result.usable:
            break
        course = result.heading_rad + yaw
        position = position + 0.05 * np.array([np.cos(course), np.sin(course), 0.0])
        yaw += 0.05
    assert np.linalg.norm(position - goal) < 0.06
