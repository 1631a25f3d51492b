"""Extraction: crop, cap, seam, determinism, any picture size, nothing found."""

from dataclasses import replace

import numpy as np
import pytest

from services.features.pipeline.extraction import extract, strongest
from services.features.pipeline.interfaces import FeatureSet, Profile
from services.features.pipeline.named_pipelines import PROFILES
from services.features.pipeline.pipeline import Pipeline
from shared.geometry.icosahedron import tangent_layout
from shared.geometry.sphere import bearings_from_lonlat, wrap_rad

CLASSIC = ("sift", "thesis", "orb", "beblid")
TURNS = 5
CROP_RAD = np.deg2rad(65.0)


def features_in(picture: np.ndarray, profile: Profile) -> FeatureSet:
    pipeline = Pipeline(profile)
    return extract(picture, pipeline.extractor, pipeline.representation, profile)


def turned_share(picture: np.ndarray, profile: Profile, turns: int) -> np.ndarray:
    """Share of keypoints found again where they belong, per sector, over all pairs of `turns` camera yaws.

    Returns:
        (turns,) shares; sector 0 is centred on the seam.
    """
    pipeline = Pipeline(profile)
    step = picture.shape[1] // turns
    views = [features_in(np.roll(picture, step * turn, axis=1), profile) for turn in range(turns)]
    found, present = np.zeros(turns), np.zeros(turns)
    for i, here in enumerate(views):
        sector = np.rint((here.lonlat_rad[:, 0] + np.pi) / (2.0 * np.pi) * turns).astype(int) % turns
        for j, matched in enumerate(pipeline.matcher.match(here, views)):
            pairs = matched.pairs
            if i == j:
                continue
            expected = here.lonlat_rad[pairs[:, 0], 0] + 2.0 * np.pi * (i - j) / turns
            right = np.abs(wrap_rad(views[j].lonlat_rad[pairs[:, 1], 0] - expected)) < np.deg2rad(1.0)
            found += np.bincount(sector[pairs[right, 0]], minlength=turns)
            present += np.bincount(sector, minlength=turns)
    return found / present


@pytest.mark.parametrize("name", CLASSIC)
def test_never_more_than_the_profile_keeps_and_none_on_the_robot_body(room, name):
    found = features_in(room(0.0, 0.0, 0.0, 400), PROFILES[name])
    assert 0.9 * PROFILES[name].keypoints <= len(found) <= PROFILES[name].keypoints
    assert np.abs(found.lonlat_rad[:, 1]).max() <= CROP_RAD
    assert (np.diff(found.scores) <= 0.0).all()
    assert len(found.descriptors) == len(found.lonlat_rad) == len(found)


def test_the_body_gives_keypoints_when_nothing_is_cropped(room):
    found = features_in(room(0.0, 0.0, 0.0, 400), replace(PROFILES["sift"], crop_deg=0.0))
    assert found.lonlat_rad[:, 1].min() < -CROP_RAD


@pytest.mark.parametrize("name", CLASSIC)
def test_the_seam_is_as_good_as_any_other_direction(room, name):
    share = turned_share(room(0.0, 0.0, 0.0, 400), PROFILES[name], TURNS)
    assert share.min() > 0.7
    assert np.ptp(share) <= 0.05


def test_only_a_continued_seam_has_keypoints(room):
    picture = room(0.0, 0.0, 0.0, 400)

    def at_the_seam(profile: Profile) -> int:
        views = [features_in(np.roll(picture, 160 * turn, axis=1), profile) for turn in range(TURNS)]
        return sum(int((np.abs(view.lonlat_rad[:, 0]) > np.pi - np.deg2rad(2.0)).sum()) for view in views)

    assert at_the_seam(PROFILES["sift_planar"]) == 0
    assert at_the_seam(PROFILES["sift"]) > 5


@pytest.mark.parametrize("name", CLASSIC)
def test_the_same_picture_gives_the_same_features(room, name):
    first, second = (features_in(room(0.0, 0.0, 0.0, 400), PROFILES[name]) for _ in range(2))
    np.testing.assert_array_equal(first.lonlat_rad, second.lonlat_rad)
    np.testing.assert_array_equal(first.descriptors, second.descriptors)


def test_bearings_do_not_depend_on_the_size_of_the_picture(room):
    profile = PROFILES["sift"]
    pipeline = Pipeline(profile)
    large, small = (
        features_in(room(0.0, 0.0, 0.0, 512), profile),
        features_in(room(0.0, 0.0, 0.0, 400), profile),
    )
    pairs = pipeline.matcher.match(large, [small])[0].pairs
    difference = large.lonlat_rad[pairs[:, 0]] - small.lonlat_rad[pairs[:, 1]]
    assert len(pairs) > 100
    assert np.abs(np.median(difference, axis=0)).max() < np.deg2rad(0.03)


@pytest.mark.parametrize("name", CLASSIC)
@pytest.mark.parametrize("shape", [(1, 2), (3, 6), (400, 800)])
def test_a_blank_or_tiny_picture_has_no_features(name, shape):
    found = features_in(np.full((*shape, 3), 128, np.uint8), PROFILES[name])
    assert len(found) == 0
    assert found.lonlat_rad.shape == (0, 2)
    assert found.descriptors.shape[1] in (32, 64, 128)


@pytest.mark.parametrize(("name", "width"), [("sift", 128), ("orb", 32), ("beblid", 64)])
def test_descriptor_widths_are_the_thesis_ones(room, name, width):
    found = features_in(room(0.0, 0.0, 0.0, 400), PROFILES[name])
    assert found.descriptors.shape[1] == width
    assert found.descriptors.dtype == np.uint8


def test_tangent_pictures_lose_no_keypoint_where_two_faces_meet(room):
    """As many keypoints next to the edges of faces as the area there holds."""
    layout = tangent_layout(9, 1)
    picture = room(0.0, 0.0, 0.0, 512)
    near = np.sin(np.deg2rad(1.5))

    def at_border(bearings):
        faces = layout.faces_of(bearings)
        return np.einsum("nek,nk->ne", layout.edge_normals[faces], bearings).min(axis=1) < near

    shares, counts = [], []
    for turn in range(2):
        profile = replace(PROFILES["sift_tangent"], keypoints=4000, crop_deg=0.0)
        found = features_in(np.roll(picture, 37 * turn, axis=1), profile)
        shares.append(at_border(bearings_from_lonlat(found.lonlat_rad.astype(float))).mean())
        counts.append(len(found))
    uniform = np.random.default_rng(1).normal(size=(20000, 3))
    expected = at_border(uniform / np.linalg.norm(uniform, axis=1, keepdims=True)).mean()
    assert min(counts) > 1000
    assert np.mean(shares) == pytest.approx(expected, rel=0.1)


def test_tangent_pictures_give_the_same_bearings_each_keypoint_once(room):
    picture = room(0.0, 0.0, 0.0, 512)
    profile = replace(PROFILES["orb_tangent"], keypoints=1000)
    found = features_in(picture, profile)
    assert np.abs(found.lonlat_rad[:, 1]).max() <= CROP_RAD
    whole = features_in(picture, replace(PROFILES["orb"], resize=None, keypoints=1000))
    pairs = Pipeline(profile).matcher.match(found, [whole])[0].pairs
    difference = found.lonlat_rad[pairs[:, 0]] - whole.lonlat_rad[pairs[:, 1]]
    assert len(pairs) > 50
    assert np.median(np.abs(difference), axis=0).max() < np.deg2rad(0.3)
    rounded = np.round(found.lonlat_rad / np.deg2rad(0.02))
    assert len(np.unique(rounded, axis=0)) > 0.8 * len(found)  # levels of the pyramid may share a corner


def test_the_strongest_come_first():
    assert strongest(np.zeros((4, 2)), np.array([0.2, 0.9, 0.1, 0.5], np.float32), 2).tolist() == [1, 3]


def test_fewer_than_wanted_are_all_taken():
    assert strongest(np.zeros((2, 2)), np.array([1, 2], np.float32), 10).tolist() == [1, 0]


def test_equal_scores_are_ordered_by_direction_not_by_input_order():
    rng = np.random.default_rng(3)
    lonlat = rng.uniform(-1.0, 1.0, (50, 2))
    scores = np.ones(50, np.float32)
    order = rng.permutation(50)
    first, shuffled = (
        lonlat[strongest(lonlat, scores, 20)],
        lonlat[order][strongest(lonlat[order], scores, 20)],
    )
    np.testing.assert_array_equal(first, shuffled)
