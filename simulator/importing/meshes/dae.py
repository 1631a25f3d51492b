"""COLLADA files -> surfaces, read by pycollada. As Gazebo does: in metres by their unit, axes as they are."""

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from simulator.importing.entities import Rgba, WorldImportError
from simulator.importing.meshes.pictures import Pictures
from simulator.importing.meshes.surfaces import FloatArray, IntArray, Look, Surface

COMMENT = re.compile(rb"<!--.*?-->", re.DOTALL)
GREY = (0.7, 0.7, 0.7)
MOST_DEPTH = 100  # nodes within nodes; untrusted input
DARK = 0.02  # an ambient colour below is none


def read_dae(data: bytes, path: Path, pictures: Pictures) -> list[Surface]:
    """Surfaces of a .dae file's scene.

    Raises:
        WorldImportError: it is not COLLADA, or damaged.
    """
    import collada
    from collada.common import DaeBrokenRefError, DaeIncompleteError, DaeUnsupportedError

    passed = [DaeBrokenRefError, DaeIncompleteError, DaeUnsupportedError]
    plain = COMMENT.sub(b"", data)  # pycollada takes comments for elements where lxml is installed
    try:
        document = collada.Collada(io.BytesIO(plain), ignore=passed, aux_file_loader=lambda _: None)
        nodes = [] if document.scene is None else document.scene.nodes
        unit = float(document.assetInfo.unitmeter or 1.0)
        scale = np.diag([unit, unit, unit, 1.0])
        found = [
            surface
            for node in nodes
            for name, instance, matrix in _geometries(node, scale, "", 0)
            for surface in _surfaces(instance, matrix, name, path, pictures)
        ]
    except WorldImportError:
        raise
    except Exception as error:  # pycollada: whatever its parts raise on a damaged file
        raise WorldImportError(
            f"{path} is not a usable COLLADA file: {type(error).__name__}: {error!s:.160}; export it again"
        ) from error
    return found


def _geometries(
    node: Any, matrix: FloatArray, name: str, depth: int
) -> Iterator[tuple[str, Any, FloatArray]]:
    """Instances of geometries below a node, with the node's name and where they are, (4, 4)."""
    if depth > MOST_DEPTH:
        raise WorldImportError(f"nodes must lie at most {MOST_DEPTH} deep")
    if hasattr(node, "geometry"):
        yield name or str(node.geometry.id), node, matrix
    elif hasattr(node, "node"):  # an instance of a node of the library
        yield from _geometries(node.node, matrix, name, depth + 1)
    elif hasattr(node, "children") and hasattr(node, "matrix"):
        own = str(node.name or node.id or name)
        for child in node.children:
            yield from _geometries(child, matrix @ np.asarray(node.matrix, float), own, depth + 1)


def _surfaces(node: Any, matrix: FloatArray, name: str, path: Path, pictures: Pictures) -> Iterator[Surface]:
    """Of one instance of a geometry."""
    materials = {material.symbol: material for material in node.materials}
    for primitive in node.geometry.primitives:
        triangles = primitive.triangleset() if hasattr(primitive, "triangleset") else primitive
        if not hasattr(triangles, "ntriangles") or not triangles.ntriangles or triangles.vertex is None:
            continue
        corners = np.asarray(triangles.vertex_index, np.int64).reshape(-1)
        material = materials.get(triangles.material)
        look, channel = _look(material, path, pictures)
        uvs = _coordinates(triangles, material, channel)
        rows = corners[:, None] if uvs is None else np.column_stack([corners, uvs[1]])
        unique, back = np.unique(rows, axis=0, return_inverse=True)
        yield Surface(
            name,
            np.asarray(triangles.vertex, float)[unique[:, 0]],
            back.reshape(-1, 3).astype(np.int64),
            look,
            None if uvs is None else uvs[0][unique[:, 1]],
        ).moved(matrix)


def _coordinates(triangles: Any, material: Any, channel: str) -> tuple[FloatArray, IntArray] | None:
    """Texture coordinates of the channel that the picture uses, and their index at each corner."""
    sets = list(triangles.texcoordset or ())
    if not sets:
        return None
    chosen = 0
    named = [str(entry[3]) for entry in triangles.sources.get("TEXCOORD", [])]
    for semantic, _, wanted in () if material is None else material.inputs:
        if semantic == channel and str(wanted) in named:
            chosen = named.index(str(wanted))
    chosen = min(chosen, len(sets) - 1)
    indices = np.asarray(triangles.texcoord_indexset[chosen], np.int64).reshape(-1)
    return np.asarray(sets[chosen], float)[:, :2], indices


def _look(material: Any, path: Path, pictures: Pictures) -> tuple[Look, str]:
    """The look of a primitive, and the channel of texture coordinates that its picture uses."""
    effect = getattr(getattr(material, "target", None), "effect", None)
    if effect is None:
        return Look((*GREY, 1.0)), ""
    two_sided, opacity = bool(effect.double_sided), _opacity(effect)
    diffuse = effect.diffuse
    if not hasattr(diffuse, "sampler"):
        return Look((*_rgb(diffuse, effect), opacity), two_sided=two_sided), ""
    pixels = pictures.named(str(diffuse.sampler.surface.image.path), path.parent, path.name)
    if pixels is None:
        return Look((*_rgb(None, effect), opacity), two_sided=two_sided), ""
    if not hasattr(effect.transparent, "sampler"):  # an alpha channel that nothing refers to
        pixels = pixels[..., :3]
    colour: Rgba = (1.0, 1.0, 1.0, opacity)
    return Look(colour, np.ascontiguousarray(pixels), two_sided), str(diffuse.texcoord or "")


def _rgb(diffuse: Any, effect: Any) -> tuple[float, float, float]:
    """The diffuse colour, else the ambient one, else grey."""
    for colour in (diffuse, effect.ambient):
        if (
            isinstance(colour, tuple | list | np.ndarray)
            and len(colour) >= 3
            and np.isfinite(colour[:3]).all()
        ):
            r, g, b = (min(1.0, max(0.0, float(value))) for value in colour[:3])
            if colour is diffuse or max(r, g, b) > DARK:
                return r, g, b
    return GREY


def _opacity(effect: Any) -> float:
    """By COLLADA 1.4.1, "Determining transparency". Exporters that mean opaque by 0 are believed."""
    share = effect.transparency
    share = 1.0 if share is None or hasattr(share, "sampler") else float(share)
    through = effect.transparent
    if through is None or hasattr(through, "sampler"):
        through = (1.0, 1.0, 1.0, 1.0)
    if effect.opaque_mode == "RGB_ZERO":
        luminance = 0.212671 * through[0] + 0.715160 * through[1] + 0.072169 * through[2]
        opacity = 1.0 - share * luminance
    else:
        opacity = share * (through[3] if len(through) > 3 else 1.0)
    return min(1.0, opacity) if opacity > DARK else 1.0
