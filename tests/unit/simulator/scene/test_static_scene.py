"""Lit meshes of a world: the same from the cache, and another light is another entry."""

import numpy as np

from simulator.scene.disk_cache import DiskCache
from simulator.scene.static_scene import lit_meshes
from simulator.world.contents import expand
from simulator.world.world_file import Lighting

EYES = np.array([[x, y, 0.8] for x in (0, 6) for y in (0, 4)], np.float32)


def lit(room, folder, even=None):
    return lit_meshes(*expand(room), even or room.lighting, EYES, DiskCache(folder, 10_000_000))


def assert_equal(ones, others):
    for one, two in zip(ones, others, strict=True):
        assert one.material == two.material
        for name in ("vertices", "normals", "uvs", "triangles"):
            a, b = getattr(one.mesh, name), getattr(two.mesh, name)
            assert a.dtype == b.dtype
            np.testing.assert_array_equal(a, b)
        np.testing.assert_array_equal(one.light, two.light)


def test_meshes_and_light_are_the_same_without_cache_into_it_and_out_of_it(room, tmp_path):
    fresh = lit(room, None)
    assert len(fresh) > 2
    assert_equal(fresh, lit(room, tmp_path))
    assert_equal(fresh, lit(room, tmp_path))
    assert len(list(tmp_path.iterdir())) == 1


def test_another_light_is_another_entry(room, tmp_path):
    dim = lit(room, tmp_path, Lighting(ambient=(0.1, 0.1, 0.1)))
    assert dim[0].light.mean() < 0.9 * lit(room, tmp_path)[0].light.mean()
    assert len(list(tmp_path.iterdir())) == 2
