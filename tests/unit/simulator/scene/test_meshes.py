"""Splitting of triangles: short edges, the same area, no gaps."""

import numpy as np
import pytest

from simulator.scene.meshes import Mesh, refined


def fan():
    vertices = np.array([(0, 0, 0), (3, 0, 0), (3, 2, 0), (0.1, 2.5, 0), (-0.2, 0.1, 0)], np.float32)
    triangles = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4)], np.uint32)
    normals = np.tile(np.array([0, 0, 1], np.float32), (5, 1))
    return Mesh(vertices, normals, vertices[:, :2].copy(), triangles)


def cross(mesh):
    corners = mesh.vertices[mesh.triangles]
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[:, 2]


def test_edges_become_short_and_the_area_stays():
    fine = refined(fan(), 0.4, 10_000)
    corners = fine.vertices[fine.triangles]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max() <= 0.4
    assert (cross(fine) > 0).all()
    assert cross(fine).sum() == pytest.approx(cross(fan()).sum(), rel=1e-5)
    np.testing.assert_allclose(fine.uvs, fine.vertices[:, :2], atol=1e-6)


def test_neighbours_share_all_vertices_on_their_edge():
    fine = refined(fan(), 0.4, 10_000)
    edges = np.sort(np.stack([fine.triangles, np.roll(fine.triangles, -1, axis=1)], axis=-1).reshape(-1, 2))
    pairs, count = np.unique(edges, axis=0, return_counts=True)
    rim = pairs[count == 1]
    length = np.linalg.norm(fine.vertices[rim[:, 0]] - fine.vertices[rim[:, 1]], axis=1).sum()
    outline = fan().vertices
    assert count.max() == 2
    assert length == pytest.approx(
        np.linalg.norm(outline - np.roll(outline, 1, axis=0), axis=1).sum(), rel=1e-5
    )


def test_number_of_triangles_is_bounded_and_small_ones_are_left_alone():
    assert len(refined(fan(), 0.001, 5000).triangles) <= 5000
    assert refined(fan(), 10.0, 5000).triangles.tolist() == fan().triangles.tolist()
