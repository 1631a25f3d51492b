"""Tangent images: 80 faces of 256 x 256, each direction in exactly one of them."""

import numpy as np
import pytest

from shared.geometry.icosahedron import tangent_layout
from shared.geometry.sphere import lonlat_from_bearings

LAYOUT = tangent_layout()


def directions(count=4000):
    b = np.random.default_rng(3).normal(size=(count, 3))
    return b / np.linalg.norm(b, axis=1, keepdims=True)


@pytest.mark.parametrize(
    ("base", "subdivision", "faces", "size"), [(9, 1, 80, 256), (9, 0, 20, 512), (8, 2, 320, 64)]
)
def test_number_and_size_of_faces(base, subdivision, faces, size):
    layout = tangent_layout(base, subdivision)
    assert layout.triangles.shape == (faces, 3, 3)
    assert {(v.width, v.height) for v in layout.views} == {(size, size)}


def test_faces_cover_the_sphere_once():
    a, b, c = (LAYOUT.triangles[:, k] for k in range(3))
    triple = np.einsum("fi,fi->f", a, np.cross(b, c))
    denominator = 1.0 + np.sum(a * b, axis=1) + np.sum(b * c, axis=1) + np.sum(c * a, axis=1)
    solid_angle = 2.0 * np.arctan2(triple, denominator)
    assert (solid_angle > 0.0).all()  # all counter-clockwise seen from outside
    assert solid_angle.sum() == pytest.approx(4.0 * np.pi)


def test_each_direction_lies_inside_the_face_it_belongs_to():
    b = directions()
    faces = LAYOUT.faces_of(b)
    depth = np.einsum("nek,nk->ne", LAYOUT.edge_normals[faces], b)
    assert depth.min() > -1e-12
    inside = (np.einsum("fek,nk->nfe", LAYOUT.edge_normals, b) > 1e-9).all(axis=2)
    assert (inside.sum(axis=1) <= 1).all()


def test_centre_belongs_to_its_own_face_and_to_the_middle_of_its_picture():
    np.testing.assert_array_equal(LAYOUT.faces_of(LAYOUT.centres), np.arange(80))
    for view, centre in zip(LAYOUT.views, LAYOUT.centres, strict=True):
        np.testing.assert_allclose(view.pixels_from_bearings(centre), (128.0, 128.0), atol=1e-9)


def test_each_direction_is_in_the_picture_of_its_face_and_is_kept_once():
    b = directions(500)
    kept = np.zeros(500, dtype=int)
    for face, view in enumerate(LAYOUT.views):
        pixels = view.pixels_from_bearings(b)
        seen = np.nan_to_num(((pixels >= 0.0) & (pixels < 256.0)).all(axis=1))
        assert seen[LAYOUT.faces_of(b) == face].all()
        kept[seen] += LAYOUT.owned(face, pixels[seen])
    np.testing.assert_array_equal(kept, 1)


def test_no_face_is_centred_on_a_pole():
    assert np.abs(lonlat_from_bearings(LAYOUT.centres)[:, 1]).max() < np.deg2rad(85.0)


def test_impossible_levels_are_refused():
    with pytest.raises(ValueError, match="subdivision"):
        tangent_layout(1, 2)
