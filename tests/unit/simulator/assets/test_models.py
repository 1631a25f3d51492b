"""Models from files: size, axes, looks, and every fault named with its file."""

import copy

import numpy as np
import pytest
from PIL import Image

from simulator.scene.mesh_shapes import mesh_of
from simulator.world.contents import expand
from simulator.world.world_file import WorldFile, WorldFileError
from tests.unit.simulator.assets.conftest import BOX, QUADS, gltf_box, obj_text


def shown(world):
    return [part for part in expand(world)[0] if part.shape == "mesh"]


def extent(world):
    points = np.concatenate([mesh_of(part).vertices for part in shown(world)])
    return points.min(axis=0), points.max(axis=0)


def test_y_up_file_stands_on_the_floor_with_its_z_axis_ahead(show, box_obj):
    low, high = extent(show(file=box_obj))
    np.testing.assert_allclose(high - low, (4, 2, 1), atol=1e-5)
    np.testing.assert_allclose((low + high)[:2] / 2, (4, 2), atol=1e-5)
    assert low[2] == pytest.approx(0.0, abs=1e-6)


@pytest.mark.parametrize(
    ("options", "size"),
    [
        ({"up": "z"}, (2, 1, 4)),
        ({"scale": 0.1}, (0.4, 0.2, 0.1)),
        ({"size_m": [1.0, 1.0, 0.5]}, (1.0, 1.0, 0.5)),
        ({"size_m": [None, None, 0.5]}, (2.0, 1.0, 0.5)),
    ],
)
def test_size_and_axes_follow_the_options(show, box_obj, options, size):
    low, high = extent(show(file=box_obj, **options))
    np.testing.assert_allclose(high - low, size, atol=1e-5)


def test_origin_of_the_file_is_kept_on_request(show, box_obj):
    low, high = extent(show(file=box_obj, centred=False))
    np.testing.assert_allclose(low, (4, 2, 0), atol=1e-5)
    np.testing.assert_allclose(high, (8, 4, 1), atol=1e-5)


def test_normals_point_outwards_and_edges_stay_sharp(show, box_obj):
    mesh = mesh_of(shown(show(file=box_obj))[0])
    corners = mesh.vertices[mesh.triangles]
    faces = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    outwards = corners.mean(axis=1) - (4, 2, 0.5)
    assert ((faces * outwards).sum(axis=1) > 0).all()
    assert (np.abs(mesh.normals).max(axis=1) > 0.999).all()


def test_large_faces_become_small_triangles_for_the_light(show, box_obj):
    mesh = mesh_of(shown(show(file=box_obj))[0])
    corners = mesh.vertices[mesh.triangles]
    assert np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=-1).max() <= 0.36


def test_picture_of_an_mtl_is_shown_the_right_way_up(show, checks, tmp_path):
    (tmp_path / "m.mtl").write_text(f"newmtl a\nmap_Kd {checks}\n")
    text = "mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n"
    (tmp_path / "m.obj").write_text(text)
    part = shown(show(file="m.obj"))[0]
    top = int(np.argmax(part.geometry.mesh.vertices[:, 2]))
    u, v = part.geometry.mesh.uvs[top]
    assert (u, v) == pytest.approx((0.0, 0.0))  # v counts from the top
    assert part.material.picture.pixels[0, 0].tolist() == [255, 0, 0]


def test_picture_and_plain_colour_of_gltf_are_shown(show, write_gltf, checks, tmp_path):
    plain = shown(show(file=write_gltf(gltf_box((255, 0, 0)))))[0]
    assert plain.material.picture.pixels.reshape(-1, 3).tolist() == [[255, 0, 0]] * 4
    tree = gltf_box((255, 255, 255), (tmp_path / checks).read_bytes())
    textured = shown(show(file=write_gltf(tree)))[0]
    assert textured.material.picture.pixels.shape == (16, 16, 3)
    assert textured.material.picture.pixels[0, -1].tolist() == [0, 255, 0]


def test_colours_of_vertices_are_interpolated_by_the_picture(show, tmp_path):
    text = "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n"
    (tmp_path / "c.obj").write_text(text)
    part = shown(show(file="c.obj"))[0]
    mesh, pixels = part.geometry.mesh, part.material.picture.pixels
    at = np.clip((mesh.uvs * len(pixels)).astype(int), 0, len(pixels) - 1)
    seen = pixels[at[:, 1], at[:, 0]]
    pure = {tuple(colour) for colour in seen.tolist() if sum(colour) == 255 == max(colour)}
    assert pure == {(255, 0, 0), (0, 255, 0), (0, 0, 255)}


def test_own_picture_replaces_the_looks_of_the_file(show, write_gltf, checks):
    part = shown(show(file=write_gltf(gltf_box()), texture=checks))[0]
    assert part.material.picture.pixels.shape == (16, 16, 3)


def test_changed_file_is_another_geometry_and_a_repeated_one_is_the_same(show, box_obj, tmp_path):
    one, again = shown(show(file=box_obj))[0], shown(show(file=box_obj))[0]
    (tmp_path / box_obj).write_text(obj_text(BOX * (1, 1, 0.5)))
    other = shown(show(file=box_obj))[0]
    assert one == again
    assert hash(one) == hash(again)
    assert one.geometry != other.geometry


def nan_points():
    points = BOX.copy()
    points[3, 1] = np.nan
    return points


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("no.obj", None, "no such file"),
        ("m.stl", "solid", r"must end in \.glb, \.gltf, \.obj"),
        ("m.obj", "hello", "must hold triangles|not a usable obj"),
        ("m.obj", "v 0 0 0\nv 1 0 0\n", "must hold triangles|not a usable obj"),
        ("m.obj", obj_text(nan_points()), "vertices must be finite"),
        ("m.obj", obj_text(quads=QUADS + 90), "m.obj"),
        ("m.obj", obj_text(BOX * 0), "must hold triangles"),
        ("m.obj", obj_text(BOX * 1e-5), r"0\.005 to 100 m large"),
        ("m.obj", obj_text(BOX * 1e3), r"set scale \(0\.001 for millimetres\)"),
        ("m.obj", obj_text(extra="mtllib gone.mtl\nusemtl a\n"), "gone.mtl.*no such file"),
        ("m.obj", obj_text(extra="mtllib ../../../etc/passwd\n"), "must lie in the world's folder"),
        ("m.glb", "glTF nonsense that is long enough", "not a glTF file|must be glTF 2.0"),
        ("m.gltf", "{]", "not a glTF file"),
        ("m.gltf", "{}", "has no 'asset'"),
        ("m.gltf", "[" * 100_000, "not a glTF file"),
        ("m.gltf", '{"asset": ' + "1" * 5_000 + "}", "not a glTF file"),
    ],
)
def test_broken_file_is_named_with_item_and_reason(show, tmp_path, name, content, message):
    if content is not None:
        (tmp_path / name).write_text(content)
    with pytest.raises(WorldFileError, match=r"w\.yaml: furniture\.0.*mesh") as caught:
        show(file=name)
    assert caught.match(message)


def edited(change):
    tree = copy.deepcopy(gltf_box())
    change(tree)
    return tree


@pytest.mark.parametrize(
    ("tree", "message"),
    [
        (edited(lambda t: t["accessors"][0].update(count=10**9)), "at most 600000 vertices"),
        (edited(lambda t: t["nodes"][0].update(children=[0])), "must be a tree|one parent"),
        (edited(lambda t: t.update(extensionsRequired=["KHR_draco_mesh_compression"])), "compressed"),
        (edited(lambda t: t["accessors"][1].update(bufferView=77)), "not a usable gltf"),
        (edited(lambda t: t.update(meshes=3)), "not a valid glTF"),
        (edited(lambda t: t["buffers"][0].update(uri="gone.bin")), "gone.bin.*no such file"),
        (edited(lambda t: t["asset"].update(version="1.0")), "not a usable gltf"),
        (gltf_box(picture=b"no picture"), "a picture in it must be"),
    ],
)
def test_broken_gltf_is_refused(show, write_gltf, tree, message):
    with pytest.raises(WorldFileError, match=message):
        show(file=write_gltf(tree))


@pytest.mark.parametrize("name", ["../out.obj", "/etc/passwd.obj", "sub/../../out.obj", "link.obj"])
def test_nothing_outside_the_folder_of_the_world_is_read(show, tmp_path, name):
    outside = tmp_path.parent / "out.obj"
    outside.write_text(obj_text())
    (tmp_path / "link.obj").symlink_to(outside)
    (tmp_path / "sub").mkdir()
    with pytest.raises(WorldFileError, match="must lie in the world's folder"):
        show(file=name)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, "file: Missing required argument"),
        ({"file": 3}, "file: Input should be an instance of Model"),
        ({"file": "box.obj", "scale": 1.0, "size_m": [1, 1, 1]}, "scale or size_m, not both"),
        ({"file": "box.obj", "scale": 0.0}, "above 0"),
        ({"file": "box.obj", "size_m": [None, None, None]}, "at least one of"),
        ({"file": "box.obj", "up": "x"}, "up: "),
        ({"file": "box.obj", "texture": "checks.png"}, "no texture coordinates"),
        ({"file": "box.obj", "texture": "gone.png"}, "no such file"),
        ({"file": "box.obj", "texture": "broken.png"}, "must be a PNG, JPEG or WebP"),
        ({"file": "box.obj", "texture": "huge.png"}, "at most 4096 x 4096 pixels, got 5000 x 1"),
    ],
)
def test_wrong_option_is_named(show, box_obj, checks, tmp_path, options, message):
    del box_obj, checks
    (tmp_path / "broken.png").write_bytes(b"\x89PNG nothing")
    Image.new("RGB", (5000, 1)).save(tmp_path / "huge.png")
    with pytest.raises(WorldFileError, match=message):
        show(**options)


def test_a_file_needs_a_world_file_beside_it(room_data):
    data = {**room_data, "furniture": [{"kind": "mesh", "at_m": [1, 1], "options": {"file": "a.obj"}}]}
    with pytest.raises(ValueError, match="use load_world"):
        WorldFile.model_validate(data)


def test_world_with_models_can_be_written_as_json_by_content(show, box_obj, checks, write_gltf):
    world = show(file=write_gltf(gltf_box()), texture=checks)
    options = world.furniture[0].options
    text = world.model_dump_json()
    assert options["file"].digest in text
    assert options["texture"].digest in text
    assert show(file=box_obj).model_dump_json() != text
