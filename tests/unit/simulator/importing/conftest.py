"""Small Gazebo worlds and meshes, written where a test wants them."""

from pathlib import Path

import numpy as np
import pytest
import trimesh
from PIL import Image

from simulator.importing.import_world import import_world

EXAMPLE = Path(__file__).resolve().parents[4] / "deploy/examples/gazebo/two_rooms.world"

FLOOR = """<model name="floor"><static>1</static><link name="l"><pose>0 0 -0.05 0 0 0</pose>
  <visual name="v"><geometry><box><size>8 6 0.1</size></box></geometry></visual>
  <collision name="c"><geometry><box><size>8 6 0.1</size></box></geometry></collision>
</link></model>"""

DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="{unit}"/><up_axis>{up}</up_axis></asset>
<library_images><image id="i"><init_from>{picture}</init_from></image></library_images>
<library_effects><effect id="e"><profile_COMMON>
  <newparam sid="s"><surface type="2D"><init_from>i</init_from></surface></newparam>
  <newparam sid="m"><sampler2D><source>s</source></sampler2D></newparam>
  <technique sid="t"><phong><ambient><color>0.2 0.4 0.6 1</color></ambient>
  <diffuse>{diffuse}</diffuse>{more}</phong></technique></profile_COMMON></effect></library_effects>
<library_materials><material id="look"><instance_effect url="#e"/></material></library_materials>
<library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="12">0 0 0 2 0 0 2 0 1 0 0 1</float_array><technique_common>
    <accessor source="#pa" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
    <param name="Z" type="float"/></accessor></technique_common></source>
  <source id="u"><float_array id="ua" count="8">0 0 1 0 1 1 0 1</float_array><technique_common>
    <accessor source="#ua" count="4" stride="2"><param name="S" type="float"/><param name="T" type="float"/>
    </accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <polylist count="1" material="look"><input semantic="VERTEX" source="#v" offset="0"/>
    <input semantic="TEXCOORD" source="#u" offset="1" set="0"/><vcount>4</vcount>
    <p>0 0 1 1 2 2 3 3</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="n" name="sheet">
  <matrix>1 0 0 {shift} 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
  <instance_geometry url="#g"><bind_material><technique_common>
  <instance_material symbol="look" target="#look"/></technique_common></bind_material>
  </instance_geometry></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#w"/></scene></COLLADA>"""
"""A sheet of 2 x 1 units that stands along x."""

TEXTURED = '<texture texture="m" texcoord="UV"/>'


def dae(picture="../textures/red.png", unit=1.0, up="Z_UP", shift=0.0, diffuse=TEXTURED, more=""):
    """A COLLADA file of one sheet."""
    return DAE.format(picture=picture, unit=unit, up=up, shift=shift, diffuse=diffuse, more=more)


def world_text(*models, floor=FLOOR, rest=""):
    """An SDF world with a floor of 8 x 6 m and some models."""
    return f'<sdf version="1.7"><world name="w">{floor}{"".join(models)}{rest}</world></sdf>'


def model(geometry, name="thing", pose="2 1 0 0 0 0", material="", felt=True):
    """A model of one shape."""
    shape = f"<geometry>{geometry}</geometry>"
    collision = f'<collision name="c">{shape}</collision>' if felt else ""
    return (
        f'<model name="{name}"><pose>{pose}</pose><link name="l">'
        f'<visual name="v">{shape}{material}</visual>{collision}</link></model>'
    )


def mesh(uri, more=""):
    """The geometry of a mesh file."""
    return f"<mesh><uri>{uri}</uri>{more}</mesh>"


BLOCK = "<box><size>1 0.5 0.4</size></box>"


@pytest.fixture
def folder(tmp_path):
    """A folder with models/sheet: a COLLADA sheet with a red picture beside its folder."""
    meshes, textures = tmp_path / "models/sheet/meshes", tmp_path / "models/sheet/textures"
    meshes.mkdir(parents=True)
    textures.mkdir()
    (meshes / "sheet.dae").write_text(dae(), encoding="utf-8")
    Image.new("RGB", (8, 8), (255, 0, 0)).save(textures / "red.png")
    return tmp_path


@pytest.fixture
def bring(folder):
    """Import a world of the text given."""

    def run(text, **options):
        source = folder / "w.world"
        source.write_text(text, encoding="utf-8")
        return import_world(source, folder / "out", **options)

    return run


def named(world, name):
    """The piece of furniture of a name."""
    return next(item for item in world.furniture if item.name == name)


def write_scene(path, *meshes):
    """A GLB scene of named meshes, y up."""
    scene = trimesh.Scene()
    for name, shape in meshes:
        scene.add_geometry(shape, node_name=name, geom_name=name)
    path.write_bytes(scene.export(file_type="glb"))


def y_up_box(low, high, colour=(200, 200, 200, 255)):
    """A box between two corners given with z up, as glTF has it."""
    size, middle = np.subtract(high, low), np.add(high, low) / 2
    shape = trimesh.creation.box((size[0], size[2], size[1]))
    shape.apply_translation((middle[0], middle[2], -middle[1]))
    material = trimesh.visual.material.PBRMaterial(baseColorFactor=colour)
    shape.visual = trimesh.visual.TextureVisuals(material=material)
    return shape
