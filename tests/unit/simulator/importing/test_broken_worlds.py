"""Broken worlds, meshes and scenes: one line that names the file, what was expected and what came."""

import json
import struct

import pytest

from simulator.assets.model import AssetError
from simulator.importing.entities import WorldImportError
from simulator.importing.import_world import import_world
from tests.unit.simulator.importing.conftest import (
    BLOCK,
    dae,
    mesh,
    model,
    world_text,
    write_scene,
    y_up_box,
)

SHEET = mesh("model://sheet/meshes/sheet.dae")
CIRCLE = '<frame name="a"><pose relative_to="b"/></frame><frame name="b"><pose relative_to="a"/></frame>'


def at(pose):
    return model(BLOCK).replace("<pose>2 1 0 0 0 0</pose>", pose)


WORLDS = {
    "not XML": ("<sdf><world>", "w.world is not valid XML"),
    "another format": ("<robot/>", "must be SDF, its first element <sdf>; got <robot>"),
    "nothing in it": ("<sdf><world name='w'/></sdf>", "must hold 1 to 3000 <model> and <include>.*got 0"),
    "only a floor": (
        "<sdf><world><include><uri>model://ground_plane</uri></include></world></sdf>",
        "must hold something besides floor and light",
    ),
    "no level floor": (world_text(model(BLOCK, pose="0 0 0 0.7 0 0"), floor=""), "must have a level floor"),
    "floor under everything": (
        world_text(model("<box><size>8 6 2</size></box>", pose="0 0 1 0 0 0")),
        "nowhere on its floor.*is room for the robot",
    ),
    "pose of five numbers": (world_text(at("<pose>1 2 3 4 5</pose>")), "pose must be x y z.*'1 2 3 4 5'"),
    "pose that is no number": (world_text(at("<pose>1 2 3 4 5 east</pose>")), "'thing'.*'1 2 3 4 5 east'"),
    "pose that is not finite": (world_text(at("<pose>1 2 nan 0 0 0</pose>")), "6 finite numbers.*nan"),
    "unknown frame": (world_text(at('<pose relative_to="x">1 0 0 0 0 0</pose>')), "relative to frame 'x'"),
    "frames in a circle": (world_text(CIRCLE, at('<pose relative_to="a"/>')), "not go round in a circle"),
    "empty geometry": (world_text(model("")), "'thing' visual 'v': <geometry> must hold a shape"),
    "box of two sides": (world_text(model("<box><size>1 2</size></box>")), "box size must be x y z, 3"),
    "negative box": (world_text(model("<box><size>1 -2 1</size></box>")), r"above 0.*\[1.0, -2.0, 1.0\]"),
    "cylinder without length": (
        world_text(model("<cylinder><radius>1</radius></cylinder>")), "cylinder length must be a number"
    ),
    "scale of nought": (world_text(model(mesh("model://sheet/meshes/sheet.dae", "<scale>1 0 1</scale>"))),
                        "scale must not be 0, got 1 0 1"),
    "mesh without uri": (world_text(model("<mesh/>")), "<mesh> must have a <uri>, got none"),
    "mesh of an unknown scheme": (world_text(model(mesh("ftp://sheet.dae"))), "must begin with model://"),
    "mesh of an unknown format": (world_text(model(mesh("w.world"))), r"must end in \.dae"),
    "missing mesh": (world_text(model(mesh("model://gone.dae"))), "visual 'v': 'model://gone.dae' is not in"),
    "missing model": (world_text("<include><uri>model://gone</uri></include>"), "'model://gone' is not in"),
    "model to be downloaded": (
        world_text("<include><uri>https://fuel.gazebosim.org/1.0/me/models/Chair</uri></include>"),
        "must be downloaded first: gz fuel download",
    ),
    "include without uri": (world_text("<include/>"), "<include> must have a <uri>"),
    "missing submesh": (
        world_text(model(mesh("model://sheet/meshes/sheet.dae", "<submesh><name>lid</name></submesh>"))),
        "has no submesh 'lid'; it has sheet",
    ),
    "colour that is none": (
        world_text(model(BLOCK, material="<material><diffuse>red</diffuse></material>")), "diffuse must be"
    ),
    "mesh of 200 m": (world_text(model(mesh("model://sheet/meshes/sheet.dae", "<scale>100 1 1</scale>"))),
                      r"becomes a world that cannot be used: out.yaml: .*0\.005 to 100 m large, got 200"),
    "lamp of an endless strength": (
        world_text(rest='<light name="a" type="point"><diffuse>1 1 inf</diffuse></light>'), "'a': diffuse"
    ),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), WORLDS.values(), ids=WORLDS)
def test_broken_world_is_refused_in_one_line(bring, text, message):
    with pytest.raises(WorldImportError, match=message) as caught:
        bring(text)
    assert "\n" not in str(caught.value)
    assert "w.world" in str(caught.value) or "sheet.dae" in str(caught.value)


MESHES = {
    "not COLLADA": ("sheet.dae", b"<x", "sheet.dae is not a usable COLLADA file"),
    "another XML": ("sheet.dae", b"<html/>", "sheet.dae"),
    "COLLADA cut short": ("sheet.dae", dae().encode()[:900], "sheet.dae is not a usable COLLADA file"),
    "COLLADA of letters": ("sheet.dae", dae().replace("0 0 1</float", "0 0 x</float").encode(), "sheet.dae"),
    "COLLADA of another vertex": ("sheet.dae", dae().replace("3 3</p>", "9 3</p>").encode(), "sheet.dae"),
    "COLLADA without triangles": ("sheet.dae", dae().replace("instance_geometry", "instance_x").encode(),
                                  "must hold triangles"),
    "pointer of Git LFS": ("sheet.dae", b"version https://git-lfs.github.com/spec/v1\n", "git lfs pull"),
    "STL of nothing": ("sheet.stl", b"solid x\nendsolid x\n", "sheet.stl"),
    "OBJ of nothing": ("sheet.obj", b"hello", "sheet.obj"),
    "OBJ without end": ("sheet.obj", b"v 0 0 0\nv 1 0 0\nv 0 nan 0\nf 1 2 3\n", "finite"),
    "glTF of nothing": ("sheet.glb", b"glTFnothing", "sheet.glb"),
}  # fmt: skip


@pytest.mark.parametrize(("name", "data", "message"), MESHES.values(), ids=MESHES)
def test_broken_mesh_is_named_and_can_be_left_out(bring, folder, name, data, message):
    (folder / "models/sheet/meshes" / name).write_bytes(data)
    text = world_text(model(mesh(f"model://sheet/meshes/{name}")))
    with pytest.raises(WorldImportError, match=message) as caught:
        bring(text)
    assert "\n" not in str(caught.value)
    result = bring(text, leave_out=True)
    assert [item.name for item in result.world.furniture] == ["floor"]
    assert len([note for note in result.notes if name in note]) == 1


@pytest.mark.parametrize("name", ["gone.dae", "sheet.dae"])
def test_what_is_felt_stands_in_for_what_cannot_be_seen(bring, folder, name):
    (folder / "models/sheet/meshes/sheet.dae").write_bytes(b"broken")
    collision = f"<geometry>{BLOCK}</geometry>"
    text = model(mesh(f"model://sheet/meshes/{name}"), felt=False)
    text = text.replace("</visual>", f'</visual><collision name="c">{collision}</collision>')
    world = bring(world_text(text), leave_out=True).world
    patches = world.furniture[-1].options["file"].patches
    assert [patch.seen for patch in patches] == [True]


def glb(header, binary=b""):
    """A GLB file of a header that may say anything."""
    text = header if isinstance(header, bytes) else json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    body = (
        struct.pack("<II", len(text), 0x4E4F534A)
        + text
        + struct.pack("<II", len(binary), 0x004E4942)
        + binary
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


ASSET = {"version": "2.0"}
SCENES = {
    "no glTF": (b"hello", "is not a glTF file"),
    "cut short": (glb({"asset": ASSET})[:30], "scene.glb"),
    "version 1": (struct.pack("<4sIIII", b"glTF", 1, 20, 0, 0), "must be glTF 2.0, got version 1"),
    "no asset": (glb({}), "has no 'asset'"),
    "empty": (glb({"asset": ASSET}), "scene.glb"),
    "compressed": (glb({"asset": ASSET, "extensionsRequired": ["KHR_draco_mesh_compression"]}), "compressed"),
    "nodes in a circle": (
        glb({"asset": ASSET, "nodes": [{"children": [1]}, {"children": [0]}]}), "must be a tree|one parent"
    ),
    "a billion vertices": (glb({"asset": ASSET, "accessors": [{"count": 10**9}]}), "at most 6000000 vert"),
    "lists for numbers": (glb({"asset": ASSET, "nodes": 3}), "scene.glb"),
}  # fmt: skip


@pytest.mark.parametrize(("data", "message"), SCENES.values(), ids=SCENES)
def test_broken_scene_is_refused_in_one_line(tmp_path, data, message):
    (tmp_path / "scene.glb").write_bytes(data)
    with pytest.raises((WorldImportError, AssetError), match=message) as caught:
        import_world(tmp_path / "scene.glb", tmp_path / "out")
    assert "scene.glb" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_what_is_no_world_at_all_is_refused(tmp_path):
    with pytest.raises(WorldImportError, match="there is no such file"):
        import_world(tmp_path / "gone.world", tmp_path / "out")
    (tmp_path / "plan.dwg").write_text("x")
    with pytest.raises(WorldImportError, match=r"must end in \.glb, \.gltf, \.sdf, \.world"):
        import_world(tmp_path / "plan.dwg", tmp_path / "out")
    (tmp_path / "w.world").write_text(world_text(model(BLOCK)))
    with pytest.raises(WorldImportError, match=r"--models .*gone must be a folder"):
        import_world(tmp_path / "w.world", tmp_path / "out", models=[tmp_path / "gone"])


def test_start_in_a_wall_or_beside_the_floor_is_refused(tmp_path):
    write_scene(
        tmp_path / "room.glb",
        ("floor", y_up_box((0, 0, -0.1), (4, 4, 0))),
        ("block", y_up_box((1, 1, 0), (2, 2, 1))),
    )
    for start in ((1.5, 1.5, 0.0), (9.0, 9.0, 0.0)):
        with pytest.raises(WorldImportError, match=r"room\.glb"):
            import_world(tmp_path / "room.glb", tmp_path / "out", start=start)


def test_import_that_fails_leaves_what_was_imported_before(bring, folder):
    before = bring(world_text(model(SHEET, "sheet"))).path
    text, models = before.read_text(encoding="utf-8"), sorted((folder / "out/models").iterdir())
    with pytest.raises(WorldImportError):
        bring(world_text(model(SHEET, "other"), model("<sphere><radius>x</radius></sphere>")))
    assert before.read_text(encoding="utf-8") == text
    assert sorted((folder / "out/models").iterdir()) == models
    assert [path.name for path in folder.iterdir() if path.name.startswith(".")] == []


def test_models_that_include_themselves_end(bring, folder):
    (folder / "models/self").mkdir()
    text = '<sdf version="1.6"><model name="self"><include><uri>model://self</uri></include></model></sdf>'
    (folder / "models/self/model.sdf").write_text(text)
    with pytest.raises(WorldImportError, match="does one include itself"):
        bring(world_text("<include><uri>model://self</uri></include>"))
