"""Surfaces in heaps that fit a file: nothing lost, nothing twice, pictures counted once a heap."""

import numpy as np

from simulator.importing.meshes import cutting
from simulator.importing.meshes.surfaces import Look, Surface


def sheet(columns, look=None):
    """A strip of unit squares along x."""
    x, y = np.meshgrid(np.arange(columns + 1.0), np.arange(2.0))
    points = np.stack([x.ravel(), y.ravel(), np.zeros(x.size)], axis=-1)
    low = np.arange(columns)
    high = low + columns + 1
    triangles = np.concatenate([np.stack([low, low + 1, high + 1], -1), np.stack([low, high + 1, high], -1)])
    return Surface("strip", points, triangles, look or Look(), uvs=points[:, :2])


def test_what_fits_stays_in_one_heap_and_in_order():
    surfaces = [sheet(3), sheet(5)]
    assert cutting.heaps(surfaces) == [surfaces]
    assert cutting.heaps([]) == []


def test_large_mesh_is_cut_along_its_length_without_losing_a_triangle(monkeypatch):
    monkeypatch.setattr(cutting, "MOST_TRIANGLES", 50)
    whole = sheet(100)
    heaps = cutting.heaps([whole])
    assert [sum(len(one.triangles) for one in heap) for heap in heaps] == [50, 50, 50, 50]
    parts = [one for heap in heaps for one in heap]
    corners = np.concatenate([one.vertices[one.triangles] for one in parts])
    expected = whole.vertices[whole.triangles]
    np.testing.assert_array_equal(_ordered(corners), _ordered(expected))
    assert all(np.ptp(one.vertices[:, 0]) <= 26 for one in parts)
    assert all((one.uvs == one.vertices[:, :2]).all() for one in parts)


def test_many_pictures_are_shared_out_and_one_picture_counts_once(monkeypatch):
    monkeypatch.setattr(cutting, "MOST_TEXELS", 100)
    looks = [Look(picture=np.zeros((8, 8, 3), np.uint8)) for _ in range(3)]
    assert [len(heap) for heap in cutting.heaps([sheet(1, look) for look in looks])] == [1, 1, 1]
    assert [len(heap) for heap in cutting.heaps([sheet(1, looks[0]) for _ in range(3)])] == [3]


def _ordered(triangles):
    return np.sort(triangles.reshape(len(triangles), -1).view(), axis=0)
