"""Prisms of meshes: where they stand, what stays free between them, and that sensors and physics agree."""

import numpy as np
import pytest

from simulator.scene.parts import Material, Part
from simulator.scene.prisms import MOST_PRISMS, hull_outline, prisms_of
from simulator.scene.shapes import box
from simulator.world.footprints import cast_rays, clearance_m, footprints

CORNERS = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
QUADS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
BOX = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]])


def boxes(*spans):
    """Vertices and triangles of boxes given by (low, high) corners."""
    points = [np.array(low) + CORNERS * (np.array(high) - np.array(low)) for low, high in spans]
    return np.concatenate(points), np.concatenate([BOX + 8 * k for k in range(len(spans))])


def in_band(prisms, low, high):
    return [one for one in prisms if one.high_m > low and one.low_m < high]


def test_box_is_one_prism_of_its_size():
    (prism,) = prisms_of(*boxes(((0, 0, 0), (2, 1, 0.75))))
    assert (prism.low_m, prism.high_m) == pytest.approx((0.0, 0.75))
    np.testing.assert_allclose(np.ptp(prism.outline_m, axis=0), (2, 1), atol=0.01)


def test_floor_between_the_legs_of_a_table_stays_free():
    legs = [((x, y, 0), (x + 0.1, y + 0.1, 0.8)) for x in (0, 1.9) for y in (0, 0.9)]
    prisms = prisms_of(*boxes(((0, 0, 0.8), (2, 1, 0.85)), *legs))
    below = in_band(prisms, 0.02, 0.79)
    assert len(below) == 4
    assert all(np.ptp(one.outline_m, axis=0).max() < 0.12 for one in below)
    assert len(in_band(prisms, 0.82, 1.0)) == 1


def test_touching_pieces_of_one_mesh_are_one_outline():
    points, triangles = boxes(((0, 0, 0), (1, 1, 0.5)), ((1, 0, 0), (2, 1, 0.5)))
    (prism,) = prisms_of(points, triangles)  # they share corners
    np.testing.assert_allclose(np.ptp(prism.outline_m, axis=0), (2, 1), atol=0.01)


def test_pyramid_gets_narrower_towards_its_top():
    points = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0), (0, 0, 1)], float)
    triangles = np.array([(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4), (0, 2, 1), (0, 3, 2)])
    prisms = sorted(prisms_of(points, triangles), key=lambda one: one.low_m)
    widths = [np.ptp(one.outline_m, axis=0)[0] for one in prisms]
    assert widths[0] == pytest.approx(2.0, abs=0.01)
    assert widths == sorted(widths, reverse=True)
    assert widths[-1] < 0.3


def test_sheet_gets_a_thickness():
    points = np.array([(0, 0, 0), (0, 2, 0), (0, 2, 1), (0, 0, 1)], float)
    for prism in prisms_of(points, np.array([(0, 1, 2), (0, 2, 3)])):
        assert np.ptp(prism.outline_m, axis=0).min() > 0.003
        assert prism.high_m > prism.low_m


def test_thousand_leaves_are_put_together_and_too_many_pieces_are_refused():
    rng = np.random.default_rng(1)
    leaves = [(low, low + 0.05) for low in rng.uniform((0, 0, 0), (0.5, 0.5, 0.9), (1000, 3))]
    assert 0 < len(prisms_of(*boxes(*leaves))) <= MOST_PRISMS
    spread = [(low, low + 0.05) for low in rng.uniform((0, 0, 0), (9, 9, 0.9), (1000, 3))]
    with pytest.raises(ValueError, match="choose collision: box"):
        prisms_of(*boxes(*spread))


def test_round_outline_has_few_corners_and_holds_every_point():
    angles = np.linspace(0, 2 * np.pi, 200)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=-1)
    outline = hull_outline(circle)
    assert len(outline) == 16
    ahead = np.roll(outline, -1, axis=0) - outline
    delta = circle[:, None] - outline[None]
    assert (ahead[None, :, 0] * delta[..., 1] - ahead[None, :, 1] * delta[..., 0] > -1e-6).all()
    assert np.hypot(*outline.T).max() < 1.03


def test_rectangle_as_hull_gives_the_same_distances_as_a_box():
    stuff = Material("lacquer")
    solid = box((-0.6, 0.6), (-0.2, 0.2), (0.0, 1.0), stuff, yaw_rad=0.7)
    corners = ((-0.6, -0.2), (0.6, -0.2), (0.6, 0.2), (-0.6, 0.2))
    hull = Part("hull", (0.0, 0.0, 0.5), (1.2, 0.4, 1.0), stuff, yaw_rad=0.7, outline_m=corners)
    spike = Part("hull", (9.0, 9.0, 0.5), (1, 1, 1), stuff, outline_m=((0, 0), (1, 0), (0, 1)))
    one, other = footprints((solid,), 0.02, 0.79), footprints((hull, spike), 0.02, 0.79)
    rng = np.random.default_rng(2)
    points = rng.uniform(-2, 2, (300, 2))
    np.testing.assert_allclose(clearance_m(points, other), clearance_m(points, one), atol=1e-9)
    angles = np.linspace(-np.pi, np.pi, 181)
    for origin in points[:20]:
        np.testing.assert_allclose(
            cast_rays(origin, angles, other, 4.0), cast_rays(origin, angles, one, 4.0), atol=1e-9
        )
