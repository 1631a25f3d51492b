"""World files and the models they show."""

import base64
import copy
import io
import json
import struct
from pathlib import Path
from typing import Any

import yaml
from PIL import Image

from simulator.assets.folder import AssetFolder
from simulator.assets.model import AssetError
from simulator.world.world_file import WorldFileError, load_world
from tests.fuzz.decoder import Decoder, Shape
from tests.unit.simulator.assets.conftest import gltf_box, obj_text

ROOT = Path(__file__).resolve().parents[3]
YAML_TOKENS = (
    b"&a ",
    b"*a",
    b"<<: ",
    b"!!python/object:",
    b"? ",
    b"- ",
    b": ",
    b"\t",
    b"|",
    b".nan",
    b"0x",
    b"1e999",
)
OBJ_TOKENS = (
    b"f 1 2 3\n",
    b"v 1e99 0 0\n",
    b"vt 0 0\n",
    b"usemtl x\n",
    b"mtllib ../../x.mtl\n",
    b"-1",
    b"nan",
    b"g ",
)
GLTF_TOKENS = (
    b'"count":4294967295',
    b'"byteLength":-1',
    b'"uri":"../../x"',
    b'"children":[0]',
    b"NaN",
    b"[" * 2000,
)
ROOM = {
    "format": "topnav-world/1",
    "name": "plain",
    "start": {"x_m": 2.0, "y_m": 2.0, "yaw_deg": 10},
    "sky": {"clouds": 0.5},
    "rooms": [
        {
            "name": "room",
            "x_m": [0, 6],
            "y_m": [0, 4],
            "floor": {"texture": "boards", "colour": [170, 130, 90], "seed": 1, "tile_m": 2.0},
            "walls": {"texture": "lacquer", "colour": [200, 200, 200]},
            "ceiling": {"texture": "lacquer", "colour": [220, 220, 220]},
        }
    ],
    "furniture": [
        {"kind": "dining_table", "at_m": [5.0, 3.0], "options": {"length_m": 1.0, "width_m": 1.0}},
        {"kind": "sofa", "name": "sofa", "at_m": [2, 1], "yaw_deg": 90, "seed": 3},
    ],
}  # fmt: skip


def decoders(scratch: Path) -> list[Decoder]:
    """World files as YAML; models as OBJ and as glTF, text and binary."""
    file = scratch / "w.yaml"

    def world(data: bytes) -> None:
        file.write_bytes(data)
        assert load_world(str(file)).rectangles()

    seeds = (folded(ROOM), (ROOT / "simulator/worlds/break_room.yaml").read_bytes())
    picture = io.BytesIO()
    Image.new("RGB", (4, 4), (200, 30, 30)).save(picture, "PNG")
    plain, textured = gltf_box(), gltf_box(picture=picture.getvalue())
    boxes = tuple(_to_json(tree) for tree in (plain, textured))
    return [
        Decoder(
            "worlds/file", world, (WorldFileError,), seeds, YAML_TOKENS, Shape(unfolded, folded), cpu_s=5.0
        ),
        _model(scratch, "obj", (obj_text().encode(),), OBJ_TOKENS, None),
        _model(scratch, "gltf", boxes, GLTF_TOKENS, Shape(_from_json, _to_json)),
        _model(scratch, "glb", (_glb(plain), _glb(textured)), GLTF_TOKENS, None),
    ]


def unfolded(data: bytes) -> Any:
    """YAML -> tree."""
    try:
        return copy.deepcopy(yaml.load(data, Loader=yaml.CSafeLoader))
    except (yaml.YAMLError, ArithmeticError, LookupError, AttributeError) as error:
        raise ValueError(str(error)) from error


def folded(tree: Any) -> bytes:
    """Tree -> YAML; without the references that PyYAML makes of values that stand there twice."""
    text: str = yaml.dump(json.loads(json.dumps(tree)), Dumper=yaml.CSafeDumper)
    return text.encode("utf-8", "surrogatepass")


def _model(
    scratch: Path, suffix: str, seeds: tuple[bytes, ...], tokens: tuple[bytes, ...], shape: Shape | None
) -> Decoder:
    folder = scratch / suffix
    folder.mkdir(parents=True, exist_ok=True)

    def run(data: bytes) -> None:
        (folder / f"m.{suffix}").write_bytes(data)
        assert AssetFolder(folder).model(f"m.{suffix}").patches

    return Decoder(f"worlds/{suffix}", run, (AssetError,), seeds, tokens, shape, cpu_s=3.0, memory_mb=200)


def _glb(tree: dict[str, Any]) -> bytes:
    """A glTF tree with its data inside as one binary file."""
    buffer = tree["buffers"][0]
    binary = base64.b64decode(buffer["uri"].partition(",")[2])
    text = json.dumps(tree | {"buffers": [{"byteLength": buffer["byteLength"]}]}).encode()
    text, binary = text + b" " * (-len(text) % 4), binary + bytes(-len(binary) % 4)
    chunks = [
        struct.pack("<I4s", len(body), kind) + body for kind, body in ((b"JSON", text), (b"BIN\0", binary))
    ]
    whole = b"".join(chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(whole)) + whole


def _from_json(data: bytes) -> Any:
    return json.loads(data)


def _to_json(tree: Any) -> bytes:
    return json.dumps(tree).encode()
