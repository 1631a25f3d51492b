"""The sky beyond open ground, and the sun's shadows."""

import numpy as np
import pytest

from simulator.scene.lighting import Sunlight, bake
from simulator.scene.mesh_shapes import mesh_of
from simulator.scene.parts import Material
from simulator.scene.shapes import box
from simulator.scene.sky import RADIUS_M, backdrop, sky_picture, sunlight
from simulator.world.world_file import Sky, load_world

NOON = Sunlight((0.0, 0.0, 1.0), (1.0, 1.0, 1.0))
LOW = Sunlight((-np.sqrt(0.5), 0.0, np.sqrt(0.5)), (1.0, 1.0, 1.0))


def test_worlds_without_open_ground_have_no_sky():
    assert backdrop(load_world("apartment")) == []
    assert sunlight(load_world("apartment")) is None


def test_the_dome_is_seen_from_inside():
    dome, land = (mesh_of(part) for part in backdrop(load_world("village")))
    corners = dome.vertices[dome.triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    inward = np.array([32.0, 32.0, 0.8]) - corners.mean(axis=1)
    area = np.linalg.norm(normals, axis=1)
    assert ((normals * inward).sum(axis=1)[area > 1e-3] > 0.0).all()
    assert np.ptp(dome.vertices[:, 0]) == pytest.approx(2 * RADIUS_M, rel=0.01)
    assert land.vertices[:, 2].max() < 0.0


def test_the_sky_has_no_seam_and_follows_its_seed():
    sky = sky_picture(Sky(seed=3))
    step = np.abs(np.diff(sky.astype(float), axis=1)).mean()
    seam = np.abs(sky[:, 0].astype(float) - sky[:, -1]).mean()
    assert seam < 3.0 * step + 1.0
    assert (sky == sky_picture(Sky(seed=3))).all()
    assert (sky != sky_picture(Sky(seed=4))).any()


def test_more_clouds_are_whiter():
    assert sky_picture(Sky(clouds=0.9)).mean() > sky_picture(Sky(clouds=0.1)).mean() + 10.0


@pytest.mark.parametrize(("sun", "dark_x", "bright_x"), [(LOW, 1.2, -1.2), (NOON, 0.0, 1.2)])
def test_things_cast_shadows_away_from_the_sun(sun, dark_x, bright_x):
    block = box((-0.5, 0.5), (-2.0, 2.0), (0.4, 1.4), Material("concrete"))
    floor = np.array([[x, 0.0, 0.0] for x in (dark_x, bright_x)], np.float32)
    up = np.tile(np.array([[0.0, 0.0, 1.0]], np.float32), (2, 1))
    corners = np.array([[-4, -4, 0], [4, 4, 2]], np.float32)
    points, normals = np.concatenate([floor, corners]), np.concatenate([up, up])
    light = bake(points, normals, (block,), (), (0.2, 0.2, 0.2), 0.0, np.random.default_rng(0), sun)
    assert light[0].mean() < 0.7 * light[1].mean()
