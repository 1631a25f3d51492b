"""How textures lie on boxes."""

import numpy as np
import pytest

from simulator.scene.mesh_shapes import mesh_of
from simulator.scene.parts import Material
from simulator.scene.shapes import box

TILE_M, HIGH_M = 1.6, 2.1


def front(low_m, kind):
    """Vertices and texture coordinates of the face of a panel that looks along -y."""
    mesh = mesh_of(box((low_m, low_m + TILE_M), (0.0, 0.2), (0.0, HIGH_M), Material(kind), tile_m=TILE_M))
    faces = mesh.normals[:, 1] < -0.9
    return mesh.vertices[faces], mesh.uvs[faces]


def at(vertices, uvs, x_m, z_m):
    ((uv,),) = [uvs[np.isclose(vertices[:, 0], x_m) & np.isclose(vertices[:, 2], z_m, atol=1e-5)]]
    return uv


@pytest.mark.parametrize("kind", ["bricks", "paving"])
def test_courses_are_level_and_go_on_from_one_panel_to_the_next(kind):
    """A panel higher than wide had its bricks standing upright, as planks do."""
    here, there = front(0.0, kind), front(TILE_M, kind)
    along, up = at(*here, TILE_M, 0.0) - at(*here, 0.0, 0.0), at(*here, 0.0, HIGH_M) - at(*here, 0.0, 0.0)
    assert np.abs(along) == pytest.approx([1.0, 0.0], abs=1e-5)
    assert np.abs(up) == pytest.approx([0.0, HIGH_M / TILE_M], abs=1e-5)
    assert at(*here, TILE_M, 0.0) == pytest.approx(at(*there, TILE_M, 0.0), abs=1e-5)


def test_the_grain_of_a_plank_runs_along_it():
    vertices, uvs = front(0.0, "planks")
    up = at(vertices, uvs, 0.0, HIGH_M) - at(vertices, uvs, 0.0, 0.0)
    assert np.abs(up) == pytest.approx([HIGH_M / TILE_M, 0.0], abs=1e-5)
