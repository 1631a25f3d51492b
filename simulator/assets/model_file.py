"""Model files (glTF 2.0, OBJ) -> patches. Parsed by trimesh; what it passes over in silence is an error."""

import hashlib
import io
from pathlib import Path
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from simulator.assets.gltf_guard import MOST_VERTICES, check_header, header_of, textured_primitives
from simulator.assets.model import AssetError, Model, Patch
from simulator.assets.picture_file import picture_from_image, picture_of
from simulator.assets.shading import creased, painted

SUFFIXES = (".glb", ".gltf", ".obj")
MOST_TRIANGLES = 200_000  # untrusted input: as in gltf_guard
GAMMA = 1 / 2.2  # of the renderer's textures; colours of glTF are linear
GREY = (190, 190, 190)  # of what has no look; by eye
GLASS = 0.5  # what is less opaque is looked through; also glTF's own alphaCutoff


class Neighbours(Protocol):
    """Reads the files that a model names."""

    faults: list[str]

    def read(self, name: str) -> bytes:
        """Content of a file, by its path relative to the model."""

    def digest(self) -> bytes:
        """Hash of all that was read."""


def read_model(path: Path, data: bytes, neighbours: Neighbours) -> Model:
    """Make a model of a file's content.

    Raises:
        AssetError: not a model, too large, broken, or a file that it names is.
    """
    name, suffix = path.name, path.suffix.lower().lstrip(".")
    header = {} if suffix == "obj" else header_of(data, name)
    check_header(header, name)
    scene = parsed(data, suffix, name, neighbours)
    looks = [getattr(shape.visual, "material", None) for shape in scene.geometry.values()]
    pictures = sum(getattr(look, "baseColorTexture", None) is not None for look in looks)
    if pictures < textured_primitives(header):
        raise AssetError(f"{name}: a picture in it must be a PNG, JPEG or WebP file; export it again")
    try:
        patches = _patches(scene, suffix != "obj", name)
    except AssetError:
        raise
    except (ArithmeticError, AttributeError, LookupError, TypeError, ValueError) as error:
        raise AssetError(f"{name} is damaged: {error!r:.120}; export it again") from error
    if not patches:
        raise AssetError(f"{name} must hold triangles, got none; export the mesh, not points or lines")
    digest = hashlib.sha256(name.encode() + b"\0" + data + neighbours.digest()).hexdigest()[:32]
    return Model(digest, name, tuple(patches))


def _patches(scene: Any, linear: bool, name: str) -> list[Patch]:
    patches: list[Patch] = []
    total = 0
    for node in scene.graph.nodes_geometry:
        transform, key = scene.graph[node]
        shape = scene.geometry[key]
        if not hasattr(shape, "faces") or not len(shape.faces):
            continue
        total += len(shape.faces)
        if total > MOST_TRIANGLES:
            raise AssetError(f"{name} must have at most {MOST_TRIANGLES} triangles, got {total}; reduce it")
        patches.append(_patch(shape, np.asarray(transform, float), linear, name))
    return [patch for patch in patches if len(patch.mesh.triangles)]


def parsed(data: bytes, suffix: str, name: str, neighbours: Neighbours) -> Any:
    """The scene that trimesh makes of a file's content; AssetError if it makes none.

    A file that it names and that cannot be read is an error where `neighbours` keeps it as a fault.
    """
    import trimesh  # half a second, for worlds with models only

    class Named(trimesh.resolvers.Resolver):  # type: ignore[misc]
        """Hands trimesh the files that the model names."""

        def __init__(self) -> None:
            self.file_name = name

        def get(self, name: str) -> bytes:
            return neighbours.read(name)

        def write(self, name: str, data: Any) -> None:
            raise NotImplementedError

        def keys(self) -> list[str]:
            return []

        def namespaced(self, namespace: str) -> "Named":
            raise NotImplementedError

    try:
        scene = trimesh.load_scene(
            io.BytesIO(data), file_type=suffix, resolver=Named(), process=False, split_objects=False
        )
    except Exception as error:
        if neighbours.faults:
            raise AssetError(f"{name} names a file: {neighbours.faults[0]}") from error
        raise AssetError(
            f"{name} is not a usable {suffix} file: {type(error).__name__}: {error!s:.120}; export it again"
        ) from error
    if neighbours.faults:
        raise AssetError(f"{name} names a file: {neighbours.faults[0]}")
    return scene


def _patch(shape: Any, transform: npt.NDArray[np.float64], linear: bool, name: str) -> Patch:
    """One geometry of the file; `linear` says that its colours are not gamma-encoded."""
    triangles = np.asarray(shape.faces, np.int64)
    check_arrays(np.asarray(shape.vertices, float), triangles, name)
    vertices = np.asarray(shape.vertices, float) @ transform[:3, :3].T + transform[:3, 3]
    check_arrays(vertices, triangles, name)
    if np.linalg.det(transform[:3, :3]) < 0:
        triangles = triangles[:, ::-1]
    material = getattr(shape.visual, "material", None)
    image = getattr(material, "baseColorTexture", None) or getattr(material, "image", None)
    uvs = getattr(shape.visual, "uv", None)
    if uvs is not None:
        uvs = np.asarray(uvs, float)
        if uvs.shape != (len(vertices), 2) or not np.isfinite(uvs).all():
            raise AssetError(f"{name}: texture coordinates must be finite, one per vertex; export it again")
        uvs = np.stack([uvs[:, 0], 1.0 - uvs[:, 1]], axis=-1)
    mesh, source = creased(vertices, triangles, uvs)
    two_sided = bool(getattr(material, "doubleSided", False))
    base, seen = base_colour(material, linear), _opacity(material) >= GLASS
    if image is not None and uvs is not None:
        pixels = picture_from_image(image, f"texture of {name}", _cutoff(material)).pixels
        if base.min() < 255:
            pixels = (pixels * np.append(base / 255.0, 1.0)[: pixels.shape[2]]).astype(np.uint8)
        return Patch(mesh, picture_of(pixels), True, two_sided, seen)
    colours = vertex_colours(shape, linear)
    if colours is not None and material is None:
        base = np.full(3, 255.0)
    whole = np.broadcast_to(base, (len(vertices), 3)) if colours is None else colours * (base / 255.0)
    if len(mesh.triangles) == 0:
        return Patch(mesh, picture_of(np.zeros((2, 2, 3), np.uint8)), False, two_sided)
    own, pixels = painted(mesh, np.asarray(whole, np.uint8)[source])
    if uvs is not None:  # another picture may be put on it
        own = mesh if len(np.unique(whole, axis=0)) == 1 else own
    return Patch(own, picture_of(pixels), uvs is not None and own is mesh, two_sided, seen)


def _opacity(material: Any) -> float:
    """Of a whole surface, 0 to 1: what a glTF material that blends says."""
    factor = getattr(material, "baseColorFactor", None)
    if getattr(material, "alphaMode", None) != "BLEND" or factor is None:
        return 1.0
    return float(np.asarray(factor, float).reshape(-1)[3]) / 255.0


def _cutoff(material: Any) -> float | None:
    """Less opaque than this a texture has holes; None where its opacity does not count."""
    mode = getattr(material, "alphaMode", None)
    if mode == "MASK":
        cutoff = getattr(material, "alphaCutoff", None)
        return GLASS if cutoff is None else float(cutoff)
    return GLASS if mode == "BLEND" else None


def check_arrays(
    vertices: npt.NDArray[np.float64],
    triangles: npt.NDArray[np.int64],
    name: str,
    most_triangles: int = MOST_TRIANGLES,
    most_vertices: int = MOST_VERTICES,
) -> None:
    """Raise AssetError unless triangles name vertices that are there, finite and not too many."""
    if len(triangles) > most_triangles or len(vertices) > most_vertices:
        raise AssetError(
            f"{name} must have at most {most_triangles} triangles and {most_vertices} vertices, "
            f"got {len(triangles)} and {len(vertices)}; reduce the mesh"
        )
    if triangles.ndim != 2 or triangles.shape[1] != 3 or vertices.ndim != 2 or vertices.shape[1] != 3:
        raise AssetError(f"{name} must be made of triangles; export it again")
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise AssetError(
            f"{name}: triangles must name vertices 0 to {len(vertices) - 1}, got {triangles.min()} to "
            f"{triangles.max()}; export it again"
        )
    bad = ~np.isfinite(vertices).all(axis=1)
    if bad.any():
        raise AssetError(
            f"{name}: vertices must be finite, got {vertices[bad][0].tolist()} at {int(np.argmax(bad))}"
        )
    if np.abs(vertices).max() > 1e6:
        raise AssetError(
            f"{name}: coordinates must be below 1e6, got {np.abs(vertices).max():.3g}; repair it"
        )


def base_colour(material: Any, linear: bool) -> npt.NDArray[np.float64]:
    """Colour that the texture or the vertices are multiplied with, gamma-encoded 0..255; (3,)."""
    factor = getattr(material, "baseColorFactor", None)
    if factor is None and material is not None and getattr(material, "image", None) is None:
        factor = getattr(material, "diffuse", None)
    if factor is None:
        has_look = material is not None and (
            getattr(material, "baseColorTexture", None) is not None
            or getattr(material, "image", None) is not None
        )
        return np.array((255, 255, 255) if has_look or linear else GREY, float)
    colour = np.asarray(factor, float).reshape(-1)[:3]
    if colour.shape != (3,) or not np.isfinite(colour).all():
        return np.array(GREY, float)
    colour = np.clip(colour, 0, 255)
    return np.asarray(np.round(255.0 * (colour / 255.0) ** GAMMA) if linear else colour)


def vertex_colours(shape: Any, linear: bool) -> npt.NDArray[np.float64] | None:
    """(n, 3) gamma-encoded 0..255, None if the file gives none."""
    colours = None
    if getattr(shape.visual, "kind", None) == "vertex":
        colours = shape.visual.vertex_colors
    else:
        colours = getattr(shape.visual, "vertex_attributes", {}).get("color")
    if colours is None or len(colours) != len(shape.vertices):
        return None
    values = np.asarray(colours)
    scale = {"u1": 1.0, "u2": 255.0 / 65535.0}.get(values.dtype.str[1:], 255.0)
    rgb = np.clip(values[:, :3].astype(float) * scale, 0.0, 255.0)
    return np.asarray(np.round(255.0 * (rgb / 255.0) ** GAMMA) if linear else rgb)
