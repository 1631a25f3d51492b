"""The pose of a photo in synthetic rooms: plane, arcs, votes, refinement, with and without a focal length."""

import numpy as np
import pytest

from shared.geometry.photo.plane import (
    FOVS_RAD,
    USUAL_RAD,
    area_sr,
    focal_of,
    fov_of,
    plane_from_lonlat,
    rays,
)
from shared.geometry.photo.refine import COARSE_RAD, FINE_RAD, refine
from shared.geometry.photo.sightings import PhotoPose, likelihood_ratio, misses, score
from shared.geometry.photo.votes import vote
from shared.geometry.sphere import lonlat_from_bearings
from tests.unit.shared.geometry.photo.photo_scene import Shot, sightings

PLACES = [(0.0, 0.0), (0.7, 0.0), (0.0, 0.8), (-0.6, 0.2)]


def test_a_focal_length_of_half_the_longer_side_sees_90_degrees():
    assert focal_of(np.pi / 2) == pytest.approx(1.0)
    assert fov_of(focal_of(1.1)) == pytest.approx(1.1)


def test_a_face_of_a_cube_is_a_sixth_of_the_sphere():
    assert area_sr(1.0, 1.0) == pytest.approx(4.0 * np.pi / 6.0)
    assert area_sr(10.0, 0.75) == pytest.approx(4.0 * 0.75 / 100.0, rel=0.02)  # flat where it is narrow


def test_points_of_the_plane_come_back_from_their_bearings():
    plane = np.array([[0.0, 0.0], [0.9, -0.7], [-1.0, 0.75]])
    bearing, far = rays(plane, 1.4)
    assert far[0] == pytest.approx(1.4)
    assert plane_from_lonlat(lonlat_from_bearings(bearing), 1.4) == pytest.approx(plane)


def test_what_two_spots_see_in_the_pose_that_is_true_misses_by_noise_only():
    shot = Shot()
    seen = sightings(np.random.default_rng(1), shot, PLACES, wrong=0.0)
    missed = misses(seen, shot.pose)
    assert np.degrees(np.abs(missed.across_rad)).mean() < 0.25
    assert np.degrees(np.abs(missed.beyond_rad)).mean() < 0.05
    assert np.abs(missed.log_scale).mean() < 0.12


def test_beside_a_panorama_both_coordinates_are_foretold_and_far_from_it_one():
    shot = Shot(position_m=(0.0, 0.0, 0.0))
    seen = sightings(np.random.default_rng(2), shot, [(0.0, 0.0), (1.2, -0.9)], wrong=0.0)
    missed = misses(seen, shot.pose)
    beside = seen.place_m[:, 0] == 0.0
    assert np.degrees(missed.arc_rad[beside]).max() < 0.1
    assert np.degrees(np.median(missed.arc_rad[~beside])) > 20.0
    ratio = likelihood_ratio(missed, np.deg2rad(0.3))
    assert np.median(ratio[beside]) > 10.0 * np.median(ratio[~beside])


def test_votes_find_how_the_photo_is_turned_among_wrong_matches():
    shot = Shot(position_m=(0.1, 0.1, 0.0))
    seen = sightings(np.random.default_rng(3), shot, [(0.0, 0.0)], wrong=0.5)
    bearing, _ = rays(seen.plane, focal_of(shot.fov_rad))
    heard = vote(bearing, seen.direction, seen.right, np.random.default_rng(0))
    assert heard is not None
    turn = np.arccos((np.trace(heard.rotation.T @ shot.rotation) - 1.0) / 2.0)
    assert np.degrees(turn) < 5.0
    assert heard.count > 0.4 * len(seen)


def test_a_vote_needs_two_matches_that_agree():
    one = np.array([[1.0, 0.0, 0.0]])
    assert vote(one, one, np.array([0.9]), np.random.default_rng(0)) is None


@pytest.mark.parametrize("seed", range(4))
def test_the_pose_is_found_to_centimetres_from_a_start_half_a_metre_off(seed):
    rng = np.random.default_rng(seed)
    shot = Shot(position_m=(*rng.uniform(-0.5, 0.5, 2), 0.2), yaw_rad=rng.uniform(-3, 3), pitch_rad=0.25)
    seen = sightings(rng, shot, PLACES)
    told = shot.pose.log_focal + 0.01  # whole millimetres of a film's focal length
    start = PhotoPose(shot.rotation, shot.pose.position_m + np.array([0.3, -0.4, -0.2]), told)
    pose = refine(seen, start, COARSE_RAD + FINE_RAD, told, focal_known=True)
    assert np.linalg.norm(pose.position_m - shot.position_m) < 0.12
    assert np.degrees(np.arccos(pose.rotation[:, 0] @ shot.rotation[:, 0])) < 1.0


@pytest.mark.parametrize("fov_deg", [68.0, 92.0])
def test_an_unknown_focal_length_is_found_with_the_pose(fov_deg):
    shot = Shot(fov_rad=np.deg2rad(fov_deg))
    seen = sightings(np.random.default_rng(7), shot, PLACES)
    usual = np.log(focal_of(USUAL_RAD))
    starts = [PhotoPose(shot.rotation, np.zeros(3), np.log(focal_of(fov_rad))) for fov_rad in FOVS_RAD]
    poses = [refine(seen, start, COARSE_RAD + FINE_RAD, usual, focal_known=False) for start in starts]
    pose = max(poses, key=lambda each: score(seen, each)[0])
    assert np.degrees(fov_of(np.exp(pose.log_focal))) == pytest.approx(fov_deg, abs=4.0)
    assert np.linalg.norm(pose.position_m - shot.position_m) < 0.25


def test_the_true_pose_has_more_evidence_than_one_a_metre_off_or_turned():
    shot = Shot()
    seen = sightings(np.random.default_rng(8), shot, PLACES)
    true, explained = score(seen, shot.pose)
    aside = PhotoPose(shot.rotation, shot.pose.position_m + np.array([1.0, 0.0, 0.0]), shot.pose.log_focal)
    turned = PhotoPose(Shot(yaw_rad=1.1).rotation, np.array(shot.position_m), shot.pose.log_focal)
    assert explained.sum() > 0.4 * len(seen)
    assert true > 2.0 * max(score(seen, aside)[0], score(seen, turned)[0], 0.0)
