"""Level cameras first; any motion where they leave doubts; a turn is no way, and chance no motion."""

import dataclasses

import numpy as np
import pytest

from shared.geometry.perspective import rotation_z
from shared.geometry.rotation import fit_rotation
from shared.geometry.sphere import bearings_from_lonlat, lonlat_from_bearings
from shared.geometry.two_view import Cues, TwoViewSettings, two_view
from tests.unit.shared.geometry.synthetic_room import error_deg, make_scene, rotation_x

LIMITS = TwoViewSettings()


@pytest.mark.parametrize("tilt_deg", [1.0, 3.0, 8.0, 15.0])
def test_a_camera_that_leans_is_answered_as_well_as_one_that_does_not(tilt_deg):
    rng, errors = np.random.default_rng(11), []
    for k in range(12):
        scene = make_scene(rng, 80, 30, noise_deg=0.15, tilt_deg=tilt_deg)
        cues = Cues(np.where(scene.correct, 0.8, 0.2))
        result = two_view(scene.current, scene.target, np.random.default_rng(k), cues=cues)
        assert result.usable
        errors.append(error_deg(result.heading_rad, scene.heading_rad))
    assert np.median(errors) < 0.6
    assert np.quantile(errors, 0.8) < 2.0


def test_level_cameras_are_answered_as_such():
    rng = np.random.default_rng(12)
    for k in range(15):
        scene = make_scene(rng, 60, 20, noise_deg=0.15)
        result = two_view(scene.current, scene.target, np.random.default_rng(k))
        assert (result.status, result.model) == ("ok", "planar")


def test_what_is_near_tells_the_way_where_most_of_what_agrees_is_too_far_to_move():
    """A yard under clouds: of the matches a third move, by ten times what the median of all says."""
    rng = np.random.default_rng(13)
    for k in range(12):
        near, sky = make_scene(rng, 30, noise_deg=0.15), make_scene(rng, 60, distance_m=0.0, noise_deg=0.15)
        turn = near.yaw_rad - sky.yaw_rad
        target = sky.target - [turn, 0.0]
        result = two_view(
            np.concatenate([near.current, sky.current]),
            np.concatenate([near.target, target]),
            np.random.default_rng(k),
            cues=Cues(np.full(90, 0.9)),
        )
        assert result.usable
        assert error_deg(result.heading_rad, near.heading_rad) < 3.0
        assert result.disparity_rad > np.deg2rad(3.0)


def test_who_says_that_cameras_stand_level_gets_no_other_answer():
    scene = make_scene(np.random.default_rng(11), 80, 40, noise_deg=0.15, tilt_deg=10.0)
    limits = dataclasses.replace(LIMITS, tilting=False)
    assert two_view(scene.current, scene.target, np.random.default_rng(0), limits).model != "tilted"


@pytest.mark.parametrize("tilt_deg", [0.0, 1.0, 2.0, 5.0, 10.0])
def test_a_turn_on_the_spot_is_no_way_however_the_camera_leans(tilt_deg):
    rng, statuses = np.random.default_rng(14), []
    for k in range(12):
        scene = make_scene(rng, 60, 10, distance_m=0.0, tilt_deg=tilt_deg, noise_deg=0.1)
        statuses.append(two_view(scene.current, scene.target, np.random.default_rng(k)).status)
    assert statuses.count("no_baseline") == 12


@pytest.mark.parametrize("tilt_deg", [0.0, 3.0])
def test_a_short_way_is_one_all_the_same(tilt_deg):
    rng, errors = np.random.default_rng(17), []
    for k in range(12):
        scene = make_scene(rng, 80, 10, distance_m=0.15, tilt_deg=tilt_deg, noise_deg=0.1)
        result = two_view(scene.current, scene.target, np.random.default_rng(k))
        if result.usable:
            errors.append(error_deg(result.heading_rad, scene.heading_rad))
    assert len(errors) >= 10
    assert np.median(errors) < 3.0


@pytest.mark.parametrize("tilt_deg", [0.0, 5.0])
def test_what_hardly_moves_is_told_from_what_does(tilt_deg):
    rng = np.random.default_rng(18)
    near = make_scene(rng, 60, distance_m=1.0, tilt_deg=tilt_deg, noise_deg=0.1)
    turned = make_scene(rng, 60, distance_m=0.0, tilt_deg=tilt_deg, noise_deg=0.1)
    for scene, most in ((near, 60), (turned, 0)):
        found = two_view(scene.current, scene.target, np.random.default_rng(0))
        assert found.moved is not None
        assert 0.8 * most <= found.moved <= min(most, found.inliers)
    nothing = two_view(near.current[:3], near.target[:3], np.random.default_rng(0))
    assert nothing.moved is None


def test_wrong_matches_alone_are_refused():
    rng, usable = np.random.default_rng(15), 0
    for k in range(30):
        scene = make_scene(rng, 60, 60)
        usable += two_view(scene.current, scene.target, np.random.default_rng(k)).usable
    assert usable == 0


def test_distinctive_matches_find_a_motion_that_is_lost_among_dull_ones():
    rng = np.random.default_rng(18)
    found = {"dull": 0, "told apart": 0}
    for k in range(20):
        scene = make_scene(rng, 120, 105, noise_deg=0.15, tilt_deg=2.0)
        told = Cues(np.where(scene.correct, 0.7, 0.1))
        for name, cues in (("dull", None), ("told apart", told)):
            result = two_view(scene.current, scene.target, np.random.default_rng(k), cues=cues)
            right = result.usable and error_deg(result.heading_rad, scene.heading_rad) < 20.0
            found[name] += right
    assert found["told apart"] >= 17
    assert found["dull"] <= found["told apart"] // 2


def test_confidence_falls_with_the_share_that_a_motion_explains():
    rng, confidence = np.random.default_rng(19), []
    for wrong in (0, 30, 60):
        scene = make_scene(rng, 80, wrong, noise_deg=0.2, tilt_deg=4.0)
        result = two_view(scene.current, scene.target, np.random.default_rng(0))
        confidence.append(result.confidence)
    assert confidence == sorted(confidence, reverse=True)
    assert confidence[0] > 0.9


def test_the_same_question_has_the_same_answer():
    scene = make_scene(np.random.default_rng(20), 80, 40, tilt_deg=5.0)
    one, other = (two_view(scene.current, scene.target, np.random.default_rng(3)) for _ in range(2))
    assert (one.heading_rad, one.inliers) == (other.heading_rad, other.inliers)


def test_general_rotation_is_found_among_wrong_matches():
    points = np.random.default_rng(5).uniform(-4, 4, (60, 3))
    current = points / np.linalg.norm(points, axis=1, keepdims=True)
    turn = rotation_z(0.8) @ rotation_x(-0.1)
    target = current @ turn
    target[:25] = target[:25][::-1]
    rotation, mask = fit_rotation(current, target, np.random.default_rng(0), LIMITS.threshold_rad)
    np.testing.assert_allclose(rotation, turn, atol=1e-9)
    assert mask[25:].all()


def test_same_bearings_everywhere_raise_nothing():
    one = np.tile([[0.3, 0.2]], (40, 1))
    assert two_view(one, one, np.random.default_rng(0)).status in ("no_baseline", "inconsistent")


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


def test_bearings_of_no_length_are_refused():
    with pytest.raises(ValueError, match="must be finite"):
        two_view(np.full((8, 2), np.nan), np.zeros((8, 2)), np.random.default_rng(0))
    assert bearings_from_lonlat([0.0, 0.0]).tolist() == [1.0, 0.0, 0.0]
