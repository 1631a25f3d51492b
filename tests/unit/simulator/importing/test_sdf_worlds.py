"""SDF: poses and frames, shapes and looks, lights, what is missing and what is far away."""

import math

import numpy as np
import pytest
from PIL import Image

from simulator.importing.entities import WorldImportError
from simulator.world.freespace import free_space
from tests.unit.simulator.importing.conftest import BLOCK, FLOOR, dae, mesh, model, named, world_text

SHEET = mesh("model://sheet/meshes/sheet.dae")


def look_of(world, name):
    """The picture of the first surface of a piece."""
    return named(world, name).options["file"].patches[0].picture.pixels


@pytest.mark.parametrize(
    ("pose", "at", "yaw"),
    [
        ("<pose>1 2 0 0 0 0.5</pose>", (1, 2), math.degrees(0.5)),
        ('<pose degrees="true">1 2 0 0 0 30</pose>', (1, 2), 30.0),
        ('<pose rotation_format="quat_xyzw">1 2 0 0 0 0.70710678 0.70710678</pose>', (1, 2), 90.0),
        ('<pose relative_to="mark">1 0 0 0 0 0</pose>', (2, 2), 90.0),
    ],
)
def test_pose_is_read_in_every_way_that_sdf_writes_it(bring, pose, at, yaw):
    frame = '<frame name="mark"><pose>2 1 0 0 0 1.5707963</pose></frame>'
    thing = model(BLOCK).replace("<pose>2 1 0 0 0 0</pose>", pose)
    item = named(bring(world_text(frame, thing)).world, "thing")
    assert item.at_m == pytest.approx(at, abs=1e-3)
    assert item.yaw_deg == pytest.approx(yaw, abs=1e-2)


def test_pose_of_a_saved_state_counts(bring):
    state = '<state world_name="w"><model name="thing"><pose>-1 1.5 0 0 0 0</pose></model></state>'
    assert named(bring(world_text(model(BLOCK), rest=state)).world, "thing").at_m == (-1.0, 1.5)


def test_included_model_stands_where_the_include_says(bring, folder):
    own = model(SHEET, "sheet", pose="9 9 9 0 0 0")
    (folder / "models/sheet/model.sdf").write_text(f'<sdf version="1.6">{own}</sdf>', encoding="utf-8")
    include = "<include><uri>model://sheet</uri><name>mine</name><pose>0.5 1 0.2 0 0 0</pose></include>"
    item = named(bring(world_text(include)).world, "mine")
    assert (*item.at_m, item.z_m) == pytest.approx((0.5, 1.0, 0.2))


def test_units_and_node_transforms_of_dae_are_applied_and_its_axis_is_not(bring, folder):
    text = dae(unit=0.01, up="Y_UP", shift=100.0)
    (folder / "models/sheet/meshes/sheet.dae").write_text(text, encoding="utf-8")
    points = named(bring(world_text(model(SHEET))).world, "thing").options["file"].vertices()
    np.testing.assert_allclose(points.min(axis=0), (1.0, 0.0, 0.0), atol=1e-5)
    np.testing.assert_allclose(points.max(axis=0), (1.02, 0.0, 0.01), atol=1e-5)


def test_comments_within_a_mesh_are_passed_over(bring, folder):
    text = dae().replace("<mesh>", "<!-- exported --><mesh><!-- as triangles -->")
    (folder / "models/sheet/meshes/sheet.dae").write_text(text, encoding="utf-8")
    assert named(bring(world_text(model(SHEET))).world, "thing")


def test_scale_mirrors_and_stretches(bring):
    scaled = mesh("model://sheet/meshes/sheet.dae", "<scale>-1 1 2</scale>")
    patch = named(bring(world_text(model(scaled))).world, "thing").options["file"].patches[0]
    np.testing.assert_allclose(np.ptp(patch.mesh.vertices, axis=0), (2, 0, 2), atol=1e-5)
    assert patch.mesh.vertices[:, 0].max() <= 1e-6
    np.testing.assert_allclose(np.abs(patch.mesh.normals[:, 1]), 1.0, atol=1e-5)


def test_picture_upwards_of_the_mesh_is_shown_and_a_lost_one_is_named(bring, folder):
    assert look_of(bring(world_text(model(SHEET))).world, "thing")[0, 0].tolist() == [255, 0, 0]
    text = dae(picture="../../elsewhere/gone.png")
    (folder / "models/sheet/meshes/sheet.dae").write_text(text, encoding="utf-8")
    result = bring(world_text(model(SHEET)))
    assert any("gone.png" in note and "sheet.dae" in note for note in result.notes)
    np.testing.assert_allclose(look_of(result.world, "thing")[0, 0], (51, 102, 153), atol=2)


def test_picture_is_found_by_its_name_in_the_textures_of_its_model(bring, folder):
    text = dae(picture="file://C:\\Users\\me\\Red.PNG")
    (folder / "models/sheet/meshes/sheet.dae").write_text(text, encoding="utf-8")
    assert look_of(bring(world_text(model(SHEET))).world, "thing")[0, 0].tolist() == [255, 0, 0]


def test_picture_that_git_lfs_left_out_is_told(bring, folder):
    pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:0\n"
    (folder / "models/sheet/textures/red.png").write_text(pointer, encoding="utf-8")
    assert any("git lfs pull" in note for note in bring(world_text(model(SHEET))).notes)


@pytest.mark.parametrize(
    ("more", "seen"),
    [
        ('<transparent opaque="RGB_ZERO"><color>1 1 1 1</color></transparent>'
         "<transparency><float>0.8</float></transparency>", False),
        ('<transparent opaque="RGB_ZERO"><color>1 1 1 1</color></transparent>'
         "<transparency><float>0.0</float></transparency>", True),
        ('<transparent opaque="A_ONE"><color>1 1 1 0.2</color></transparent>', False),
        ("<transparency><float>0.0</float></transparency>", True),
    ],
)  # fmt: skip
def test_glass_of_dae_is_looked_through(bring, folder, more, seen):
    text = dae(diffuse="<color>0.5 0.5 0.5 1</color>", more=more)
    (folder / "models/sheet/meshes/sheet.dae").write_text(text, encoding="utf-8")
    patches = named(bring(world_text(model(SHEET))).world, "thing").options["file"].patches
    assert [patch.seen for patch in patches] == [seen]


def test_material_of_the_world_goes_over_that_of_the_file(bring):
    green = "<material><diffuse>0 1 0 1</diffuse></material>"
    pixels = look_of(bring(world_text(model(SHEET, material=green))).world, "thing")
    np.testing.assert_allclose(pixels.reshape(-1, 3)[0], (0, 255, 0), atol=2)


def test_albedo_map_and_material_scripts_bring_pictures(bring, folder):
    Image.new("RGB", (8, 8), (0, 0, 255)).save(folder / "models/sheet/textures/blue.png")
    script = "material Mine/Blue\n{ technique { pass { texture_unit { texture ../textures/blue.png } } } }\n"
    scripts = folder / "models/sheet/scripts"
    scripts.mkdir()
    (scripts / "mine.material").write_text(
        script.replace(" { ", "\n{\n").replace(" }", "\n}"), encoding="utf-8"
    )
    uri = "model://sheet/scripts/mine.material"
    scripted = f"<material><script><uri>{uri}</uri><name>Mine/Blue</name></script></material>"
    albedo = "<material><pbr><metal><albedo_map>model://sheet/textures/red.png</albedo_map></metal></pbr></material>"
    world = bring(
        world_text(model(BLOCK, "a", material=scripted), model(BLOCK, "b", "-2 1 0 0 0 0", albedo))
    ).world
    assert look_of(world, "a")[0, 0].tolist() == [0, 0, 255]
    assert look_of(world, "b")[0, 0].tolist() == [255, 0, 0]


def test_textures_that_gazebo_brings_are_drawn_here_and_unknown_ones_are_told(bring):
    wood, lost = (
        f"<material><script><name>{name}</name></script></material>" for name in ("Gazebo/Wood", "My/Own")
    )
    result = bring(world_text(model(BLOCK, "a", material=wood), model(BLOCK, "b", "-2 1 0 0 0 0", lost)))
    assert look_of(result.world, "a").shape[0] > 100
    assert any("My/Own" in note for note in result.notes)


def test_cylinders_and_spheres_have_their_size_and_face_outwards(bring):
    post = "<cylinder><radius>0.2</radius><length>1.0</length></cylinder>"
    world = bring(
        world_text(model(post, "post"), model("<sphere><radius>0.3</radius></sphere>", "ball"))
    ).world
    for name, size in (("post", (0.4, 0.4, 1.0)), ("ball", (0.6, 0.6, 0.6))):
        patch = named(world, name).options["file"].patches[0]
        np.testing.assert_allclose(np.ptp(patch.mesh.vertices, axis=0), size, atol=0.01)
        outwards = (patch.mesh.vertices * patch.mesh.normals).sum(axis=1)
        assert (outwards > 0.0).all()


def test_lamps_sun_and_sky_are_taken_over(bring):
    lights = (
        '<light name="a" type="point"><pose>1 1 2.2 0 0 0</pose><diffuse>0.5 0.25 0 1</diffuse>'
        "<attenuation><constant>0.3</constant><quadratic>0.03</quadratic></attenuation></light>"
        '<light name="s" type="directional"><diffuse>0.9 0.9 0.9 1</diffuse>'
        "<direction>-1 0 -1</direction></light>"
    )
    world = bring(world_text(model(BLOCK), rest=lights)).world
    lamp = next(item for item in world.furniture if item.kind == "light")
    assert (*lamp.at_m, lamp.z_m) == (1.0, 1.0, 2.2)
    assert lamp.options["colour"] == [255, 128, 0]
    assert 3.0 < lamp.options["strength"] < 8.0
    assert (world.sun.azimuth_deg, world.sun.elevation_deg) == (0.0, 45.0)


def test_floor_is_put_at_height_nought(bring):
    raised = FLOOR.replace("0 0 -0.05", "0 0 0.35")
    item = named(bring(world_text(model(BLOCK, pose="2 1 0.6 0 0 0"), floor=raised)).world, "thing")
    assert item.z_m == pytest.approx(0.2)


def test_endless_floor_ends_at_a_fence_and_at_walls_that_close_it(bring):
    plane = "<include><uri>model://ground_plane</uri></include><include><uri>model://sun</uri></include>"
    open_ = bring(world_text(model(BLOCK), floor=plane)).world
    assert open_.grounds[0].border == "fence"
    walls = [
        model("<box><size>6 0.1 1</size></box>", f"w{k}", f"{x} {y} 0.5 0 0 {yaw}")
        for k, (x, y, yaw) in enumerate([(0, 3, 0), (0, -3, 0), (3, 0, 1.5708), (-3, 0, 1.5708)])
    ]
    closed = bring(world_text(*walls, floor=plane)).world
    assert closed.grounds[0].border == "none"
    assert closed.grounds[0].x_m == pytest.approx((-3.3, 3.3), abs=0.2)
    assert free_space(closed).free.sum() * 0.05**2 == pytest.approx(5.4**2, rel=0.05)


def test_start_is_taken_as_given(bring):
    world = bring(world_text(model(BLOCK)), start=(-3.0, -2.0, 90.0)).world
    assert (world.start.x_m, world.start.y_m, world.start.yaw_deg) == (-3.0, -2.0, 90.0)


def test_missing_models_are_all_named_and_can_be_left_out(bring):
    lost = world_text(
        "<include><uri>model://gone</uri></include>",
        model(mesh("model://sheet/lost.dae")),
        model(BLOCK, "here"),
    )
    with pytest.raises(WorldImportError, match=r"2 files .*model://gone.*lost\.dae.*--models.*--leave-out"):
        bring(lost)
    result = bring(lost, leave_out=True)
    assert [item.name for item in result.world.furniture] == ["floor", "here"]
    assert len(result.notes) == 2


def test_models_are_found_in_gazebos_search_paths(bring, tmp_path_factory, monkeypatch):
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    (elsewhere / "crate").mkdir()
    text = f'<sdf version="1.6">{model(BLOCK, "crate")}</sdf>'
    (elsewhere / "crate/model.sdf").write_text(text, encoding="utf-8")
    include = world_text("<include><uri>model://crate</uri></include>")
    with pytest.raises(WorldImportError, match="model://crate"):
        bring(include)
    assert named(bring(include, models=[elsewhere]).world, "crate")
    monkeypatch.setenv("GAZEBO_MODEL_PATH", f"/nowhere:{elsewhere}")
    assert named(bring(include).world, "crate")


def test_what_flew_away_and_what_is_not_read_is_told(bring):
    far = model(BLOCK, "book", pose="1 1 343582.7 0 0 0")
    odd = model("<polyline><height>1</height></polyline>", "wall")
    result = bring(world_text(model(BLOCK), far, odd, '<actor name="walker"/>'))
    assert [item.name for item in result.world.furniture] == ["floor", "thing"]
    for word in ("'book' lies 343583 m away", "<polyline> is not read", "actor 'walker' is not shown"):
        assert any(word in note for note in result.notes)


def test_links_of_a_place_become_furniture_of_their_own_and_those_of_a_thing_do_not(bring):
    def links(apart_m):
        return "".join(
            f'<link name="l{k}"><pose>{k * apart_m - 2} 1 0.2 0 0 0</pose>'
            f'<visual name="v"><geometry>{BLOCK}</geometry></visual>'
            f'<collision name="c"><geometry>{BLOCK}</geometry></collision></link>'
            for k in range(2)
        )

    place, thing = (f'<model name="m">{links(apart_m)}</model>' for apart_m in (5.0, 1.5))
    names = [item.name for item in bring(world_text(place)).world.furniture]
    assert names == ["floor", "m l0", "m l1"]
    assert [item.name for item in bring(world_text(thing)).world.furniture] == ["floor", "m"]
