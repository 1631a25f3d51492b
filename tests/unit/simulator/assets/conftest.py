"""Small models: a box as OBJ and as glTF, in a folder with a world file that shows it."""

import base64
import copy
import json

import numpy as np
import pytest
import yaml
from PIL import Image

from simulator.world.world_file import load_world

BOX = np.array([(x, y, z) for x in (0.0, 2.0) for y in (0.0, 1.0) for z in (0.0, 4.0)])
QUADS = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])


def obj_text(points=BOX, quads=QUADS, extra=""):
    """A box of 2 x 1 x 4 as OBJ."""
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    return extra + "\n".join([*lines, *["f " + " ".join(str(k + 1) for k in quad) for quad in quads]]) + "\n"


def gltf_box(colour=(255, 0, 0), picture=None):
    """The same box as glTF with everything inside; a picture makes it textured."""
    triangles = np.concatenate([QUADS[:, [0, 1, 2]], QUADS[:, [0, 2, 3]]]).astype("<u2")
    points, uv = BOX.astype("<f4"), (BOX[:, :2] / 2).astype("<f4")
    blobs = [points.tobytes(), triangles.tobytes(), uv.tobytes()] + ([picture] if picture else [])
    starts = np.cumsum([0, *[len(blob) for blob in blobs]]).tolist()
    look = {"baseColorFactor": [*(np.array(colour) / 255).tolist(), 1]}
    inside = base64.b64encode(b"".join(blobs)).decode()
    tree = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [
            {"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0}]}],
        "materials": [{"pbrMetallicRoughness": look}],
        "buffers": [{"byteLength": starts[-1], "uri": "data:application/octet-stream;base64," + inside}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": len(blob)}
                        for start, blob in zip(starts, blobs, strict=False)],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": triangles.size, "type": "SCALAR"},
            {"bufferView": 2, "componentType": 5126, "count": len(uv), "type": "VEC2"},
        ],
    }  # fmt: skip
    if picture:
        tree["images"] = [{"bufferView": 3, "mimeType": "image/png"}]
        tree["textures"] = [{"source": 0}]
        look["baseColorTexture"] = {"index": 0}
    return tree


@pytest.fixture
def show(room_data, tmp_path):
    """Write a world that shows one model with some options, and load it."""

    def load(**options):
        data = copy.deepcopy(room_data)
        data["furniture"] = [{"kind": "mesh", "at_m": [4.0, 2.0], "options": options}]
        (tmp_path / "w.yaml").write_text(yaml.dump(data), encoding="utf-8")
        return load_world(str(tmp_path / "w.yaml"))

    return load


@pytest.fixture
def box_obj(tmp_path):
    """A plain box, box.obj."""
    (tmp_path / "box.obj").write_text(obj_text(), encoding="utf-8")
    return "box.obj"


@pytest.fixture
def checks(tmp_path):
    """A picture of four colours, checks.png: red and green above, blue and white below."""
    quarter = np.array([[(255, 0, 0), (0, 255, 0)], [(0, 0, 255), (255, 255, 255)]], np.uint8)
    Image.fromarray(quarter.repeat(8, 0).repeat(8, 1)).save(tmp_path / "checks.png")
    return "checks.png"


@pytest.fixture
def write_gltf(tmp_path):
    """Write a glTF tree under a name."""

    def write(tree, name="m.gltf"):
        (tmp_path / name).write_text(json.dumps(tree), encoding="utf-8")
        return name

    return write
