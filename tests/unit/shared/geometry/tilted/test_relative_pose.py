"""Poses against matches: residuals, change of size, five-point samples, refinement and evidence."""

import numpy as np
import pytest

from shared.geometry.perspective import rotation_y, rotation_z
from shared.geometry.tilted.five_point import five_point, poses_of
from shared.geometry.tilted.match_evidence import (
    NOISE_RAD,
    evidence,
    in_front,
    motion_ratio,
    turn_ratio,
    unlikely,
)
from shared.geometry.tilted.poses import Bearings, Poses, evaluate, upright
from shared.geometry.tilted.refine import exponential, refine
from tests.unit.shared.geometry.synthetic_room import rotation_x

ROTATION = rotation_z(0.8) @ rotation_y(0.05) @ rotation_x(-0.04)
TRAVEL = np.array([0.6, 0.7, 0.1]) / np.linalg.norm([0.6, 0.7, 0.1])
SIGNS = np.array([[1.0, 1.0], [-1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]])
TRUTH = Poses(ROTATION[None], TRAVEL[None])


def seen(count=40, noise=0.0, sized=True):
    rng = np.random.default_rng(5)
    points = rng.uniform(-4, 4, (count, 3))
    points = points[np.linalg.norm(points, axis=1) > 1.5]
    away = (points - TRAVEL) @ ROTATION
    far, far_target = np.linalg.norm(points, axis=1), np.linalg.norm(away, axis=1)
    current, target = points / far[:, None], away / far_target[:, None]
    current = current + rng.normal(0.0, noise, current.shape)
    current /= np.linalg.norm(current, axis=1, keepdims=True)
    return Bearings(current.T, target.T, np.log(far_target / far) if sized else None)


def test_true_pose_leaves_no_residual_and_foretells_every_size():
    found = evaluate(TRUTH, seen())
    assert np.abs(found.residual).max() < 1e-12
    assert np.abs(found.scale_error).max() < 1e-9
    assert (found.forward > 0.0).all()
    assert (found.same_side > 0.0).all()


def test_the_opposite_way_has_points_behind_and_sizes_the_wrong_way_round():
    back = evaluate(Poses(TRUTH.rotation, -TRUTH.travel), seen())
    assert (back.forward < 0.0).all()
    np.testing.assert_allclose(back.scale_error, 0.0, atol=1e-9)  # the law of sines knows no sign


def test_upright_poses_have_their_heading_and_yaw_and_no_tilt():
    poses = upright(np.array([0.3, -2.0]), np.array([1.0, 0.5]))
    np.testing.assert_allclose(poses.heading_rad, [0.3, -2.0])
    np.testing.assert_allclose(poses.yaw_rad, [1.0, 0.5])
    np.testing.assert_allclose(poses.tilt_rad, 0.0, atol=1e-7)
    assert unlikely(poses).max() < 1e-9 < unlikely(TRUTH)[0]


def test_five_exact_matches_contain_the_true_essential_matrix():
    matches = seen(12)
    x, y, z = TRAVEL
    truth = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ ROTATION
    truth /= np.linalg.norm(truth)
    found = five_point(matches.current.T[None, :5], matches.target.T[None, :5])
    assert 1 <= len(found) <= 10
    assert min(min(np.abs(e - truth).max(), np.abs(e + truth).max()) for e in found) < 1e-7


def four_poses():
    x, y, z = TRAVEL
    one = poses_of((np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]) @ ROTATION)[None])
    return one, one.of(np.zeros(4, dtype=int)).opposite(*SIGNS.T)


def test_one_of_the_four_poses_is_in_front_of_both_cameras():
    _, poses = four_poses()
    found = evaluate(poses, seen())
    ahead = ((found.forward > 0.0) & (found.same_side > 0.0)).all(axis=1)
    assert ahead.tolist().count(True) == 1
    np.testing.assert_allclose(poses.travel[ahead][0], TRAVEL, atol=1e-9)
    np.testing.assert_allclose(poses.rotation[ahead][0], ROTATION, atol=1e-9)
    np.testing.assert_allclose(np.linalg.det(poses.rotation), 1.0)


def test_opposite_poses_differ_by_the_signs_of_what_lies_in_front():
    one, poses = four_poses()
    first, found = evaluate(one, seen()), evaluate(poses, seen())
    np.testing.assert_allclose(np.abs(found.residual), np.abs(first.residual).repeat(4, axis=0), atol=1e-12)
    np.testing.assert_allclose(found.scale_error, first.scale_error.repeat(4, axis=0), atol=1e-9)
    np.testing.assert_allclose(found.forward, SIGNS[:, :1] * first.forward, atol=1e-12)
    np.testing.assert_allclose(found.same_side, SIGNS[:, 1:] * first.same_side, atol=1e-12)
    for (way, side), mask in zip(SIGNS, in_front(found, NOISE_RAD), strict=True):
        np.testing.assert_array_equal(in_front(first, NOISE_RAD, way, side)[0], mask)


@pytest.mark.parametrize("sized", [True, False])
def test_refinement_reaches_the_truth_from_level_cameras(sized):
    matches = seen(80, noise=1e-3, sized=sized)
    start = upright(np.array([np.arctan2(0.7, 0.6) + 0.1]), np.array([0.75]))
    right = np.full(len(matches), 0.8)
    noises = np.deg2rad([3.0, 2.0, 1.0, 0.5]).tolist()
    poses, information = refine(start, matches, right, noises, measured=2)
    heading_error = abs(float(poses.heading_rad[0]) - np.arctan2(0.7, 0.6))
    assert heading_error < np.deg2rad(0.3)
    assert heading_error < 4.0 * np.sqrt(np.linalg.inv(information[0])[3, 3])
    np.testing.assert_allclose(poses.rotation[0], ROTATION, atol=0.01)


def test_nothing_seen_leaves_a_pose_as_level_as_it_was():
    matches = Bearings(np.zeros((3, 0)), np.zeros((3, 0)), np.zeros(0))
    poses, _ = refine(upright(np.array([0.5]), np.array([0.1])), matches, np.zeros(0), [0.01])
    np.testing.assert_allclose(poses.heading_rad, 0.5)


def test_a_small_turn_is_its_vector():
    np.testing.assert_allclose(exponential(np.array([[0.0, 0.0, 0.2]]))[0], rotation_z(0.2), atol=1e-12)


def test_evidence_grows_with_what_fits_and_distinctive_misfits_speak_against():
    matches = seen()
    right = np.full(len(matches), 0.5)
    fits = evidence(right, motion_ratio(evaluate(TRUTH, matches), NOISE_RAD)[0])
    assert (fits > 3.0).all()
    wrong = Poses(TRUTH.rotation, np.roll(TRUTH.travel, 1, axis=1))
    misfit = motion_ratio(evaluate(wrong, matches), NOISE_RAD)[0]
    assert evidence(right, misfit).sum() < 0.0
    assert evidence(np.full(len(matches), 0.9), misfit).sum() < evidence(right, misfit).sum()


def test_a_turn_that_fits_says_more_than_a_way_that_does():
    turn = turn_ratio(np.zeros(1), None, NOISE_RAD)[0]
    assert turn > 100.0 * motion_ratio(evaluate(TRUTH, seen(sized=False)), NOISE_RAD).max()
    assert turn_ratio(np.array([np.deg2rad(5.0)]), None, NOISE_RAD)[0] < 1.0
