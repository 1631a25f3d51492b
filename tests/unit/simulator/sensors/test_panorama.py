"""Cube faces to panorama: directions, borders between faces, wrong sizes."""

import math

import numpy as np
import pytest

from simulator.sensors.panorama import (
    BORDER_PX,
    FACE_AXES,
    CubeToEquirect,
    directions,
    face_fov_rad,
    face_rotations,
)

WIDTH, FACE = 512, 168


def paint_faces(colour_of):
    """Faces of a world whose colour depends on direction only: (n, 3) unit vectors to (n, 3), 0 to 255."""
    focal = FACE / 2 / math.tan(face_fov_rad(FACE) / 2)
    offsets = FACE / 2 - (np.arange(FACE) + 0.5)
    left, up = np.meshgrid(offsets / focal, offsets / focal)
    rays = np.stack([np.ones_like(left), left, up], axis=-1).reshape(-1, 3)
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    faces = [colour_of(rays @ rotation.T).reshape(FACE, FACE, 3) for rotation in face_rotations()]
    return np.rint(np.concatenate(faces)).astype(np.uint8)


@pytest.mark.parametrize(
    ("row", "column", "direction"),
    [
        pytest.param(127.5, 255.5, (1, 0, 0), id="centre looks ahead"),
        pytest.param(127.5, 127.5, (0, 1, 0), id="quarter looks left"),
        pytest.param(127.5, 383.5, (0, -1, 0), id="three quarters looks right"),
        pytest.param(-0.5, 255.5, (0, 0, 1), id="top edge looks up"),
    ],
)
def test_direction_between_known_pixels(row, column, direction):
    rays = directions(WIDTH)
    r, c = math.floor(row), math.floor(column)
    near = rays[max(r, 0) : r + 2, c : c + 2].reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(near / np.linalg.norm(near), direction, atol=0.01)


def test_first_and_last_column_look_backwards_from_both_sides():
    rays = directions(WIDTH)
    assert rays[WIDTH // 4, 0, 0] < -0.99
    assert rays[WIDTH // 4, 0, 1] > 0.0 > rays[WIDTH // 4, -1, 1]


def test_panorama_of_a_smooth_world_is_smooth_across_all_borders():
    def colour(rays):
        return 127.5 + 120.0 * rays  # each channel varies by at most 120 / radian

    picture = CubeToEquirect(WIDTH, FACE)(paint_faces(colour)).astype(float)
    expected = 127.5 + 120.0 * directions(WIDTH)
    assert np.abs(picture - expected).max() < 1.5
    assert np.abs(picture[:, 0] - picture[:, -1]).max() < 120.0 * 2 * math.pi / WIDTH + 1.5


def test_half_a_pixel_of_shift_would_be_seen():
    def stripes(rays):
        angle = np.arctan2(rays[:, 1], rays[:, 0])
        return np.repeat(127.5 + 120.0 * np.sin(24 * angle)[:, None], 3, axis=1)

    picture = CubeToEquirect(WIDTH, FACE)(paint_faces(stripes))[WIDTH // 4].astype(float)
    rays = directions(WIDTH)[WIDTH // 4]
    expected = stripes(rays)
    shifted = stripes(np.roll(rays, 1, axis=0) + rays)  # half a pixel to the side
    assert np.abs(picture - expected).mean() < 0.4 * np.abs(picture - shifted).mean()


def test_faces_cover_six_perpendicular_directions_right_handedly():
    assert len({forward for forward, _ in FACE_AXES}) == 6
    for rotation in face_rotations():
        np.testing.assert_allclose(np.linalg.det(rotation), 1.0)


def test_faces_see_a_little_beyond_a_right_angle():
    assert math.tan(face_fov_rad(FACE) / 2) == pytest.approx(FACE / (FACE - 2 * BORDER_PX))


def test_wrong_face_size_is_named():
    with pytest.raises(ValueError, match=r"\(1008, 168, channels\), got \(6, 4, 3\)"):
        CubeToEquirect(WIDTH, FACE)(np.zeros((6, 4, 3), np.uint8))


def test_ranges_of_a_wall_are_along_the_rays_and_not_along_the_axes_of_the_faces():
    """Faces of a cube 2 m before the camera on every side: each has one depth, corners are further away."""
    ranges = CubeToEquirect(WIDTH, FACE).ranges(np.full((6 * FACE, FACE), 2.0, np.float32))
    np.testing.assert_allclose(ranges, 2.0 / np.abs(directions(WIDTH)).max(axis=-1), rtol=1e-5)


def test_ranges_take_one_sample_and_invent_none_between_two():
    row = np.where(np.arange(FACE) % 8 < 4, 1.0, 5.0).astype(np.float32)
    depths = np.tile(row, (6 * FACE, 1))
    warp = CubeToEquirect(WIDTH, FACE)
    along = warp.ranges(depths) * np.abs(directions(WIDTH)).max(axis=-1)
    assert set(np.round(along, 3).ravel().tolist()) == {1.0, 5.0}
