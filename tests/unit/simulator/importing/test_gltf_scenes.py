"""Whole glTF scenes: y is up, nodes become furniture, holes and glass."""

import numpy as np
import pytest
import trimesh
from PIL import Image

from simulator.importing.import_world import import_world
from simulator.importing.meshes import cutting
from simulator.world.freespace import free_space
from tests.unit.simulator.importing.conftest import named, write_scene, y_up_box

WALL = 0.1


@pytest.fixture
def room(tmp_path):
    """A room of 6 x 4 m whose walls are one mesh, with a cupboard and a pane."""
    walls = trimesh.util.concatenate(
        [
            y_up_box((-WALL, -WALL, 0), (6 + WALL, 0, 2.5)),
            y_up_box((-WALL, 4, 0), (6 + WALL, 4 + WALL, 2.5)),
            y_up_box((-WALL, 0, 0), (0, 4, 2.5)),
            y_up_box((6, 0, 0), (6 + WALL, 4, 2.5)),
        ]
    )
    pane = y_up_box((2, 1, 0), (2.02, 2, 1.5), (200, 220, 255, 60))
    pane.visual.material.alphaMode = "BLEND"
    path = tmp_path / "room.glb"
    write_scene(
        path,
        ("floor", y_up_box((-0.1, -0.1, 0.2), (6.1, 4.1, 0.3))),
        ("walls", walls),
        ("cupboard", y_up_box((4, 3, 0.3), (5, 3.6, 1.3), (255, 0, 0, 255))),
        ("pane", pane),
    )
    return import_world(path, tmp_path / "out")


def test_floor_is_found_and_put_at_height_nought(room):
    space = free_space(room.world)
    assert space.free.sum() * space.resolution_m**2 == pytest.approx(5.5 * 3.5 - 1.5 * 0.9 - 0.8, abs=1.2)
    assert named(room.world, "cupboard").z_m == pytest.approx(-0.3)
    assert not space.is_free((4.5, 3.3))
    assert not space.is_free((2.0, 1.5))


def test_things_have_their_origin_below_their_middle_and_can_be_moved(room):
    assert named(room.world, "cupboard").at_m == pytest.approx((4.5, 3.3))
    assert named(room.world, "walls").options["collision"]["outline"] == "concave"
    assert named(room.world, "cupboard").options["collision"]["outline"] == "convex"


def test_without_lamps_there_is_more_even_light(room):
    assert room.world.lighting.ambient[0] > 0.5


def test_glass_is_not_seen(room):
    assert [patch.seen for patch in named(room.world, "pane").options["file"].patches] == [False]


def test_scan_of_one_mesh_becomes_several_models_and_the_same_floor(tmp_path, monkeypatch):
    monkeypatch.setattr(cutting, "MOST_TRIANGLES", 700)
    slab, blocks = y_up_box((0, 0, -0.1), (6, 5, 0)), [y_up_box((2, 2, 0), (3, 3, 1))]
    blocks += [y_up_box((-0.1, -0.1, 0), (6.1, 0, 2)), y_up_box((-0.1, 5, 0), (6.1, 5.1, 2))]
    scan = trimesh.util.concatenate([one.subdivide().subdivide().subdivide() for one in (slab, *blocks)])
    scan.visual = trimesh.visual.ColorVisuals(
        scan, vertex_colors=np.full((len(scan.vertices), 4), 180, np.uint8)
    )
    write_scene(tmp_path / "scan.glb", ("scan", scan))
    world = import_world(tmp_path / "scan.glb", tmp_path / "out").world
    files = [item.options["file"] for item in world.furniture]
    counts = [sum(len(patch.mesh.triangles) for patch in file.patches) for file in files]
    assert len(counts) > 3
    assert max(counts) <= 700
    assert sum(counts) == len(scan.faces)
    space = free_space(world)
    assert space.free.sum() * space.resolution_m**2 == pytest.approx(5.48 * 4.48 - 1.52**2, abs=1.2)
    assert not space.is_free((2.5, 2.5))


def test_holes_of_a_picture_are_kept(tmp_path):
    pixels = np.full((16, 16, 4), 255, np.uint8)
    pixels[:, :8, 3] = 0
    leaf = trimesh.Trimesh(
        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)], process=False
    )
    material = trimesh.visual.material.PBRMaterial(baseColorTexture=Image.fromarray(pixels), alphaMode="MASK")
    leaf.visual = trimesh.visual.TextureVisuals(uv=[(0, 0), (1, 0), (1, 1), (0, 1)], material=material)
    write_scene(tmp_path / "g.glb", ("floor", y_up_box((0, 0, -0.1), (4, 4, 0))), ("leaf", leaf))
    world = import_world(tmp_path / "g.glb", tmp_path / "out").world
    alpha = named(world, "leaf").options["file"].patches[0].picture.pixels[..., 3]
    assert (alpha[:, :8] == 0).all()
    assert (alpha[:, 8:] == 255).all()


def test_parts_below_a_node_are_one_thing_unless_it_is_a_place(tmp_path):
    scene = trimesh.Scene()
    scene.add_geometry(y_up_box((0, 0, -0.1), (8, 8, 0)), node_name="floor", geom_name="floor")
    for node, wide_m in (("chair", 0.5), ("hall", 6.0)):
        scene.graph.update(node, scene.graph.base_frame, matrix=np.eye(4))
        for k in range(2):
            low = (1 + k * wide_m, 1 if node == "chair" else 5, 0)
            part = y_up_box(low, np.add(low, (0.3, 0.3, 0.5)))
            name = f"{node} {k}"
            scene.add_geometry(part, node_name=name, geom_name=name, parent_node_name=node)
    (tmp_path / "n.glb").write_bytes(scene.export(file_type="glb"))
    names = {item.name for item in import_world(tmp_path / "n.glb", tmp_path / "out").world.furniture}
    assert names == {"floor", "chair", "hall 0", "hall 1"}
