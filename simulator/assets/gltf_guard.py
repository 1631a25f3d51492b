"""What a glTF file promises, checked before anything is built from it: sizes and a tree of nodes."""

import json
import struct
from typing import Any

from simulator.assets.model import AssetError

# Untrusted input: chosen so that a file is read in seconds (tests/unit/simulator/assets).
MOST_VERTICES = 600_000
MOST_NODES, MOST_DEPTH = 5_000, 200
GLB_MAGIC, JSON_CHUNK = 0x46546C67, 0x4E4F534A  # glTF 2.0, section 4.4


def header_of(data: bytes, name: str) -> dict[str, Any]:
    """The JSON part of a .glb or .gltf file.

    Raises:
        AssetError: there is none.
    """
    try:
        text = data
        if data[:4] == b"glTF":
            magic, version, _, length, kind = struct.unpack("<5I", data[:20])
            if (magic, version, kind) != (GLB_MAGIC, 2, JSON_CHUNK):
                raise AssetError(f"{name} must be glTF 2.0, got version {version}; export it again")
            text = data[20 : 20 + length]
        header = json.loads(text)
    except AssetError:
        raise
    except (struct.error, ValueError, RecursionError) as error:  # ValueError: also a number of 5000 digits
        raise AssetError(f"{name} is not a glTF file: {error!s:.120}; export it again") from error
    if not isinstance(header, dict) or "asset" not in header:
        raise AssetError(f"{name} is not a glTF file: it has no 'asset'; export it again")
    return header


def check_header(header: dict[str, Any], name: str, most_vertices: int = MOST_VERTICES) -> None:
    """Refuse what would exhaust memory or never end.

    Raises:
        AssetError: too many vertices or nodes, nodes that are no tree, or a header of another make.
    """
    try:
        _check(header, name, most_vertices)
        textured_primitives(header)
    except (AttributeError, LookupError, TypeError) as error:
        raise AssetError(f"{name} is not a valid glTF file: {error!r:.120}; export it again") from error


def _check(header: dict[str, Any], name: str, most_vertices: int) -> None:
    needed = [str(one) for one in header.get("extensionsRequired", [])]
    if any("draco" in one or "meshopt" in one for one in needed):
        raise AssetError(f"{name} is compressed ({', '.join(needed)}); export it without compression")
    for accessor in header.get("accessors", []):
        count = accessor.get("count", 0)
        if not isinstance(count, int) or not 0 <= count <= most_vertices:
            raise AssetError(
                f"{name} must have at most {most_vertices} vertices, got {count!r:.40}; reduce the mesh"
            )
    nodes = header.get("nodes", [])
    if len(nodes) > MOST_NODES:
        raise AssetError(f"{name} must have at most {MOST_NODES} nodes, got {len(nodes)}; join them")
    _check_tree(nodes, name)


def textured_primitives(header: dict[str, Any]) -> int:
    """How many of the triangle sets that the nodes show have a picture by their material."""
    materials, meshes = header.get("materials", []), header.get("meshes", [])
    shown = {node["mesh"] for node in header.get("nodes", []) if "mesh" in node}
    primitives = [one for k in shown for one in meshes[k]["primitives"] if "material" in one]
    looks = [materials[one["material"]] for one in primitives if "TEXCOORD_0" in one["attributes"]]
    return sum("baseColorTexture" in look.get("pbrMetallicRoughness", {}) for look in looks)


def _check_tree(nodes: list[dict[str, Any]], name: str) -> None:
    parent: dict[int, int] = {}
    for k, node in enumerate(nodes):
        for child in node.get("children", []):
            if child in parent or not 0 <= child < len(nodes):
                raise AssetError(f"{name}: node {child} must exist and have one parent; export it again")
            parent[child] = k
    for start in parent:
        at, steps = start, 0
        while at in parent:
            at, steps = parent[at], steps + 1
            if steps > len(nodes) or steps > MOST_DEPTH:
                raise AssetError(f"{name}: nodes must be a tree at most {MOST_DEPTH} deep; export it again")
