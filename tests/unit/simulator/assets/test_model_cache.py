"""Models kept on disk: the same as read, read once, and never for files that depend on others."""

import dataclasses

import numpy as np
import pytest
import trimesh
from PIL import Image

from simulator.assets import model_cache
from simulator.assets.folder import AssetFolder
from simulator.scene.disk_cache import DiskCache


@pytest.fixture
def glb(tmp_path):
    """A box with a picture that has holes, and a plain one of glass."""
    pixels = np.random.default_rng(1).integers(0, 255, (16, 16, 4)).astype(np.uint8)
    materials = [
        trimesh.visual.material.PBRMaterial(baseColorTexture=Image.fromarray(pixels), alphaMode="MASK"),
        trimesh.visual.material.PBRMaterial(baseColorFactor=[90, 120, 200, 40], alphaMode="BLEND"),
    ]
    scene = trimesh.Scene()
    for k, material in enumerate(materials):
        box = trimesh.creation.box((1, 2, 3))
        box.visual = trimesh.visual.TextureVisuals(uv=box.vertices[:, :2] + 0.5, material=material)
        scene.add_geometry(box, node_name=f"n{k}", geom_name=f"n{k}")
    path = tmp_path / "box.glb"
    path.write_bytes(scene.export(file_type="glb"))
    return path


def read(path, cache):
    return AssetFolder(path.parent, cache).model(path.name)


def test_kept_model_is_the_one_that_was_read(glb, tmp_path, monkeypatch):
    cache = DiskCache(tmp_path / "cache", 10**9)
    plain, first = read(glb, None), read(glb, cache)
    monkeypatch.setattr("simulator.assets.folder.read_model", lambda *_: pytest.fail("read again"))
    again = read(glb, cache)
    assert plain == first == again
    for one, other in zip(plain.patches, again.patches, strict=True):
        assert one.picture == other.picture
        np.testing.assert_array_equal(one.picture.pixels, other.picture.pixels)
        for field in dataclasses.fields(one.mesh):
            np.testing.assert_array_equal(getattr(one.mesh, field.name), getattr(other.mesh, field.name))
        assert (one.mapped, one.two_sided, one.seen) == (other.mapped, other.two_sided, other.seen)
    assert sorted(patch.seen for patch in again.patches) == [False, True]
    shapes = {patch.picture.pixels.shape for patch in again.patches if patch.seen}
    assert shapes == {(16, 16, 4)}


def test_changed_file_is_read_anew(glb, tmp_path):
    cache = DiskCache(tmp_path / "cache", 10**9)
    before = read(glb, cache)
    glb.write_bytes(trimesh.Scene([trimesh.creation.box((1, 1, 1))]).export(file_type="glb"))
    assert read(glb, cache) != before


def test_what_names_other_files_is_never_kept(tmp_path):
    (tmp_path / "a.obj").write_text("mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    cache = DiskCache(tmp_path / "cache", 10**9)
    colours = []
    for red in ("1 0 0", "0 1 0"):
        (tmp_path / "a.mtl").write_text(f"newmtl m\nKd {red}\n")
        colours.append(read(tmp_path / "a.obj", cache).patches[0].picture.pixels[0, 0].tolist())
    assert colours == [[255, 0, 0], [0, 255, 0]]


def test_prisms_are_cut_once(tmp_path):
    cache, made = DiskCache(tmp_path, 10**9), []

    def cut():
        made.append(1)
        return [model_cache.Prism(0.0, 1.0, np.eye(3, 2)), model_cache.Prism(1.0, 2.0, np.ones((5, 2)))]

    for _ in range(2):
        found = model_cache.kept_prisms(("a",), cache, cut)
        assert [(one.low_m, one.high_m, len(one.outline_m)) for one in found] == [(0, 1, 3), (1, 2, 5)]
    assert made == [1]
    assert model_cache.kept_prisms(("none",), cache, list) == []
