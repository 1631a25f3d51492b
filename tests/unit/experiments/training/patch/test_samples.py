"""Pairs of patches show the same point, from the right panorama, at the size that its distance asks for."""

from dataclasses import replace

import numpy as np
import pytest

from experiments.training.patch.samples import Sampling, patches_of
from shared.geometry.sphere import lonlat_from_bearings
from tests.unit.experiments.training.patch.painted import painted_pair

EXACT = Sampling(keypoints=300, offset=0.0, octaves=0.0, turn_rad=0.0)


def drawn(pair, recipe=EXACT, count=200):
    return patches_of(pair, recipe, count, np.random.default_rng(5))


def alike(pictures):
    """(N,) correlation of both patches of (N, 2, 32, 32)."""
    flat = pictures.reshape(len(pictures), 2, -1).astype(float)
    flat = flat - flat.mean(axis=-1, keepdims=True)
    flat /= np.linalg.norm(flat, axis=-1, keepdims=True) + 1e-9
    return (flat[:, 0] * flat[:, 1]).sum(axis=-1)


@pytest.fixture(scope="module")
def pair():
    return painted_pair()


@pytest.fixture(scope="module")
def exact(pair):
    return drawn(pair)


def test_both_patches_show_the_same_paint(exact):
    assert len(exact) == 200
    assert exact.pictures.dtype == np.uint8
    others = np.stack([exact.pictures[:, 0], np.roll(exact.pictures[:, 1], 1, axis=0)], axis=1)
    assert np.median(alike(exact.pictures)) > 0.5
    assert abs(np.median(alike(others))) < 0.1


def test_points_lie_where_both_cameras_see_them(pair, exact):
    for side, sight in enumerate((pair.here, pair.there)):
        rays = (exact.points_m - sight.pose.position_m) @ sight.pose.rotation
        away = np.linalg.norm(rays, axis=-1)
        np.testing.assert_allclose(rays / away[:, None], exact.bearings[:, side], atol=1e-4)
        np.testing.assert_allclose(
            sight.ranges_at(lonlat_from_bearings(exact.bearings[:, side])), away, rtol=0.1
        )
    nearest = np.linalg.norm(exact.points_m - pair.here.pose.position_m, axis=-1)
    np.testing.assert_allclose(exact.ranges_m[:100], nearest[:100], rtol=1e-5)


def test_the_first_patch_is_always_of_the_first_panorama(pair):
    dark = replace(pair.there, picture=pair.there.picture // 4)
    pictures = drawn(replace(pair, there=dark)).pictures
    assert len(pictures) > 100
    assert (pictures[:, 1].max(axis=(1, 2)) <= 64).all()
    assert (pictures[:, 0].max(axis=(1, 2)) > 64).all()


def test_offset_size_and_turn_make_partners_less_alike(pair, exact):
    for changed in ({"offset": 0.3}, {"octaves": 0.8}, {"turn_rad": 0.5}):
        moved = drawn(pair, EXACT.model_copy(update=changed))
        assert np.median(alike(moved.pictures)) < np.median(alike(exact.pictures)) - 0.1


def test_what_the_other_place_does_not_see_is_no_pair():
    assert len(drawn(painted_pair(hidden=True))) == 0


def test_the_same_seed_draws_the_same_and_no_more_than_asked(pair):
    one, two = drawn(pair, Sampling(), 31), drawn(pair, Sampling(), 31)
    assert len(one) == 31
    assert np.array_equal(one.pictures, two.pictures)
