"""Writes the models of the example Gazebo world: python deploy/examples/gazebo/make_models.py FOLDER.

They are our own work: COLLADA and OBJ as modellers leave them, with pictures in a folder beside the meshes.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

from simulator.textures.catalogue import draw

Span = tuple[float, float]
Box = tuple[Span, Span, Span]
FACES = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])

WALL = 2.5
WALLS: list[Box] = [
    ((-0.1, 8.2), (-0.1, 0.0), (0.0, WALL)),
    ((-0.1, 8.2), (4.0, 4.1), (0.0, WALL)),
    ((-0.1, 0.0), (0.0, 4.0), (0.0, WALL)),
    ((8.1, 8.2), (0.0, 4.0), (0.0, 0.9)),
    ((8.1, 8.2), (0.0, 1.0), (0.9, 2.0)),
    ((8.1, 8.2), (3.0, 4.0), (0.9, 2.0)),
    ((8.1, 8.2), (0.0, 4.0), (2.0, WALL)),
    ((4.0, 4.1), (0.0, 1.4), (0.0, WALL)),
    ((4.0, 4.1), (2.6, 4.0), (0.0, WALL)),
    ((4.0, 4.1), (1.4, 2.6), (2.1, WALL)),
]
"""Two rooms, a doorway between them and a window in the east: one mesh, whose hull would fill both."""

TABLE: list[Box] = [
    ((-0.7, 0.7), (-0.4, 0.4), (0.71, 0.75)),
    *[
        ((x - 0.03, x + 0.03), (y - 0.03, y + 0.03), (0.0, 0.71))
        for x in (-0.62, 0.62)
        for y in (-0.32, 0.32)
    ],
]

DAE = """<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="0.01" name="centimeter"/><up_axis>Z_UP</up_axis></asset>
<library_images><image id="picture">
  <init_from>../materials/textures/{picture}</init_from>
</image></library_images>
<library_effects><effect id="look-fx"><profile_COMMON>
  <newparam sid="surface"><surface type="2D"><init_from>picture</init_from></surface></newparam>
  <newparam sid="sampler"><sampler2D><source>surface</source></sampler2D></newparam>
  <technique sid="common"><lambert><diffuse>
    <texture texture="sampler" texcoord="UV"/>
  </diffuse></lambert></technique>
</profile_COMMON></effect></library_effects>
<library_materials><material id="look"><instance_effect url="#look-fx"/></material></library_materials>
<library_geometries><geometry id="{name}"><mesh>
  <source id="p"><float_array id="p-array" count="{n3}">{points}</float_array>
    <technique_common><accessor source="#p-array" count="{n}" stride="3">
      <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
    </accessor></technique_common></source>
  <source id="t"><float_array id="t-array" count="{n2}">{uvs}</float_array>
    <technique_common><accessor source="#t-array" count="{n}" stride="2">
      <param name="S" type="float"/><param name="T" type="float"/>
    </accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  <triangles count="{m}" material="look">
    <input semantic="VERTEX" source="#v" offset="0"/>
    <input semantic="TEXCOORD" source="#t" offset="0" set="0"/>
    <p>{corners}</p>
  </triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="scene"><node id="{name}-node" name="{name}">
  <instance_geometry url="#{name}"><bind_material><technique_common>
    <instance_material symbol="look" target="#look">
      <bind_vertex_input semantic="UV" input_semantic="TEXCOORD" input_set="0"/>
    </instance_material>
  </technique_common></bind_material></instance_geometry>
</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
"""


def boxes(spans: list[Box], tile_m: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Corners (n, 3), texture coordinates (n, 2) along the faces, and triangles (m, 3) of boxes, z up."""
    points, uvs = [], []
    for x, y, z in spans:
        corners = np.array([(a, b, c) for a in x for b in y for c in z])
        for face in corners[FACES]:
            normal = int(np.argmin(np.ptp(face, axis=0)))
            across, up = [k for k in (0, 1, 2) if k != normal]
            points.append(face)
            uvs.append(face[:, [across, up]] / tile_m)
    quads = np.arange(4 * len(points)).reshape(-1, 4)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
    return np.concatenate(points), np.concatenate(uvs), triangles


def write_dae(path: Path, spans: list[Box], picture: str, tile_m: float) -> None:
    """Boxes as a COLLADA file in centimetres, with a picture by a path that leaves the folder."""
    points, uvs, triangles = boxes(spans, tile_m)
    text = DAE.format(
        name=path.stem, picture=picture, m=len(triangles),
        n=len(points), n2=2 * len(points), n3=3 * len(points),
        points=" ".join(f"{v:g}" for v in np.round(100 * points, 3).ravel()),
        uvs=" ".join(f"{v:g}" for v in np.round(uvs, 4).ravel()),
        corners=" ".join(map(str, triangles.ravel())),
    )  # fmt: skip
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def write_picture(path: Path, kind: str, colour: tuple[int, int, int], seed: int, side_px: int = 256) -> None:
    """A texture of ours as a small JPEG."""
    path.parent.mkdir(parents=True, exist_ok=True)
    small = Image.fromarray(draw(kind, colour, seed)).resize((side_px, side_px), Image.Resampling.LANCZOS)
    small.save(path, quality=80)


def write_vase(folder: Path) -> None:
    """A vase as OBJ with its MTL."""
    profile = [(0.06, 0.0), (0.09, 0.08), (0.11, 0.16), (0.06, 0.26), (0.08, 0.32)]
    sides = 12
    lines = ["mtllib vase.mtl", "usemtl glaze"]
    for radius, height in profile:
        angles = 2 * np.pi * np.arange(sides) / sides
        lines += [f"v {radius * np.cos(a):.4f} {radius * np.sin(a):.4f} {height:.4f}" for a in angles]
    for ring in range(len(profile) - 1):
        for k in range(sides):
            a, b = ring * sides + k, ring * sides + (k + 1) % sides
            lines.append(f"f {a + 1} {b + 1} {b + sides + 1} {a + sides + 1}")
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "vase.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "vase.mtl").write_text("newmtl glaze\nKd 0.16 0.36 0.55\n", encoding="utf-8")


def main() -> None:
    """Write the meshes and pictures of all models below the folder given."""
    folder = Path(sys.argv[1])
    write_dae(folder / "walls/meshes/walls.dae", WALLS, "plaster.jpg", 3.0)
    write_picture(folder / "walls/materials/textures/plaster.jpg", "plaster", (226, 214, 196), 3, 384)
    write_dae(folder / "table/meshes/table.dae", TABLE, "wood.jpg", 0.9)
    write_picture(folder / "table/materials/textures/wood.jpg", "wood", (150, 104, 62), 5)
    write_picture(folder / "walls/materials/textures/boards.jpg", "boards", (176, 132, 92), 1, 384)
    write_vase(folder / "vase/meshes")


if __name__ == "__main__":
    main()
