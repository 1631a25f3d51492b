"""Mesh files in any format that is read -> surfaces, each file once."""

from pathlib import Path
from typing import Any

import numpy as np

from simulator.assets.gltf_guard import check_header, header_of
from simulator.assets.model import AssetError
from simulator.assets.model_file import base_colour, check_arrays, parsed, vertex_colours
from simulator.importing.entities import WorldImportError
from simulator.importing.meshes.dae import read_dae
from simulator.importing.meshes.pictures import LFS, PictureError, Pictures, pixels_of
from simulator.importing.meshes.surfaces import Look, Pixels, Surface
from simulator.importing.sdf.resources import read_bytes

SUFFIXES = (".dae", ".glb", ".gltf", ".obj", ".stl")
MOST_TRIANGLES, MOST_VERTICES = 2_000_000, 6_000_000
"""Of a mesh; chosen: a scanned house. It becomes several models."""
MOST_BYTES = 512_000_000  # untrusted input: of a scene with its pictures
HOLE = 0.5  # alphaCutoff where glTF does not say
OPAQUE = 250
"""A picture whose bytes of opacity are all above this has no holes; chosen: what antialiasing leaves."""


class MeshFiles:
    """Reads mesh files with the pictures that they name."""

    def __init__(self, pictures: Pictures) -> None:
        """Find pictures by `pictures`, which keeps what is missing."""
        self._pictures = pictures
        self._read: dict[Path, list[Surface]] = {}
        self.parents: dict[Path, dict[str, str]] = {}
        """Of glTF files, the parent of each node by name."""

    def read(self, path: Path) -> list[Surface]:
        """Surfaces of a file, in its axes, metres.

        Raises:
            WorldImportError: of another format, damaged, too large, or without triangles.
        """
        if path not in self._read:
            self._read[path] = self._surfaces(path)
        return self._read[path]

    def _surfaces(self, path: Path) -> list[Surface]:
        suffix = path.suffix.lower()
        if suffix not in SUFFIXES:
            raise WorldImportError(f"{path} must end in {', '.join(SUFFIXES)}; convert it to one of these")
        data = read_bytes(path, MOST_BYTES)
        if data.startswith(LFS):
            raise WorldImportError(f"{path} is a pointer of Git LFS; fetch the file with 'git lfs pull'")
        try:
            found = read_dae(data, path, self._pictures) if suffix == ".dae" else self._by_trimesh(data, path)
            for surface in found:
                check_arrays(surface.vertices, surface.triangles, str(path), MOST_TRIANGLES, MOST_VERTICES)
        except AssetError as error:
            raise WorldImportError(str(error).replace(path.name, str(path), 1)) from error
        found = [surface for surface in found if len(surface.triangles)]
        if not found:
            raise WorldImportError(f"{path} must hold triangles, got none; export the mesh itself")
        return found

    def _by_trimesh(self, data: bytes, path: Path) -> list[Surface]:
        suffix = path.suffix.lower().lstrip(".")
        if suffix in {"glb", "gltf"}:
            check_header(header_of(data, path.name), path.name, MOST_VERTICES)
        scene = parsed(data, suffix, path.name, Neighbours(path, self._pictures))
        self.parents[path] = {str(a): str(b) for a, b in scene.graph.transforms.parents.items()}
        found = []
        for node in scene.graph.nodes_geometry:
            matrix, key = scene.graph[node]
            shape = scene.geometry[key]
            if hasattr(shape, "faces") and len(shape.faces):
                found.append(_surface(shape, str(node), path).moved(np.asarray(matrix, float)))
        return found


class Neighbours:
    """Reads what a mesh file names: pictures that are missing are told, other files are faults."""

    def __init__(self, path: Path, pictures: Pictures) -> None:
        self._path, self._pictures = path, pictures
        self.faults: list[str] = []

    def read(self, name: str) -> bytes:
        """Content of a file by its path relative to the mesh."""
        path = self._path.parent / name.replace("\\", "/")
        if path.suffix.lower() in {".mtl", ".bin"}:
            try:
                return read_bytes(path, MOST_BYTES)
            except WorldImportError as error:
                if path.suffix.lower() == ".bin":
                    self.faults.append(str(error))
                raise
        pixels = self._pictures.named(name, self._path.parent, self._path.name)
        if pixels is None:
            raise FileNotFoundError(name)
        return _png(pixels)

    def digest(self) -> bytes:
        """Nothing: imported files are not told apart by it."""
        return b""


def _surface(shape: Any, node: str, path: Path) -> Surface:
    linear = path.suffix.lower() in {".glb", ".gltf"}
    material = getattr(shape.visual, "material", None)
    image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    uvs = getattr(shape.visual, "uv", None)
    if uvs is not None and (np.shape(uvs) != (len(shape.vertices), 2) or not np.isfinite(uvs).all()):
        raise WorldImportError(f"{path}: texture coordinates must be finite, one per vertex; export it again")
    colour = base_colour(material, linear) / 255.0
    opacity, picture = _opacity(material), None
    if image is not None and uvs is not None:
        try:
            picture = _with_holes(pixels_of(image, f"texture of {path}"), material)
        except PictureError as error:
            raise WorldImportError(str(error)) from error
    colours = vertex_colours(shape, linear)
    if colours is not None and material is None:
        colour = np.ones(3)
    two_sided = bool(getattr(material, "doubleSided", False))
    return Surface(
        node,
        np.asarray(shape.vertices, float),
        np.asarray(shape.faces, np.int64),
        Look((float(colour[0]), float(colour[1]), float(colour[2]), opacity), picture, two_sided),
        None if uvs is None else np.asarray(uvs, float),
        None if colours is None or picture is not None else np.asarray(colours, np.uint8),
    )


def _opacity(material: Any) -> float:
    """Of a whole surface, 0 to 1."""
    if getattr(material, "alphaMode", None) == "BLEND":
        factor = getattr(material, "baseColorFactor", None)
        return 1.0 if factor is None else float(np.asarray(factor, float).reshape(-1)[3]) / 255.0
    words = getattr(material, "kwargs", {}).get("d")  # of MTL
    try:
        return min(1.0, max(0.0, float(words[-1]))) if words else 1.0
    except ValueError:
        return 1.0


def _with_holes(pixels: Pixels, material: Any) -> Pixels:
    """RGB, or RGBA whose opacity is 0 or 255, as the material says."""
    mode = getattr(material, "alphaMode", None)
    if pixels.shape[2] == 3 or mode in (None, "OPAQUE") or pixels[..., 3].min() > OPAQUE:
        return np.ascontiguousarray(pixels[..., :3])
    cutoff = getattr(material, "alphaCutoff", None) if mode == "MASK" else None
    holes = pixels[..., 3] < 255.0 * (HOLE if cutoff is None else float(cutoff))
    return np.dstack([pixels[..., :3], np.where(holes, 0, 255).astype(np.uint8)])


def _png(pixels: Pixels) -> bytes:
    import cv2

    code = cv2.COLOR_RGBA2BGRA if pixels.shape[2] == 4 else cv2.COLOR_RGB2BGR
    return bytes(cv2.imencode(".png", cv2.cvtColor(pixels, code))[1])
