"""Furniture from a user's model file: glTF or OBJ, with its textures."""

import hashlib
from typing import Literal

import numpy as np
import numpy.typing as npt
from pydantic import InstanceOf

from simulator.assets.model import AssetError, Model, Patch, UpAxis
from simulator.scene import meshes
from simulator.scene.meshes import Mesh, joined, refined
from simulator.scene.parts import Geometry, Material, Part, Picture, Piece
from simulator.scene.prisms import SKIN_M, Prism, hull_outline, prisms_of
from simulator.scene.texturing import GRAIN_M

FloatArray = npt.NDArray[np.float64]
FILES = {"file": "model", "texture": "picture"}
"""Options that name files, see catalogue."""
Collision = Literal["convex", "box", "none"]
Sides = tuple[float | None, float | None, float | None]
SMALLEST_M, LARGEST_M = 0.005, 100.0
MOST_FINE = 400_000
FROM_Y_UP = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # glTF's front, +z, becomes +x


def mesh(
    rng: np.random.Generator,
    file: InstanceOf[Model],
    scale: float | None = None,
    size_m: Sides | None = None,
    up: UpAxis = "y",
    centred: bool = True,
    solid: bool = True,
    collision: Collision = "convex",
    texture: InstanceOf[Picture] | None = None,
    two_sided: bool = False,
    glow: float = 0.0,
) -> Piece:
    """Model from a file, its middle at the origin and its lowest point on the floor.

    Args:
        rng: not needed.
        file: .glb, .gltf or .obj, relative to the world file.
        scale: metres per unit of the file, 1 if neither this nor size_m is given.
        size_m: length, width, height to fit; one that is null follows the others.
        up: axis of the file that points up; y also makes z its front, z makes x its front.
        centred: false keeps the origin of the file.
        solid: whether it stops the robot.
        collision: convex outline of each connected piece, one box round everything, or none.
        texture: picture file in place of the file's own looks; needs texture coordinates.
        two_sided: shows the backs of open surfaces too.
        glow: above 0 it shines evenly and needs no light.
    """
    del rng
    key = (scale, size_m, up, centred, solid, collision, texture, two_sided, glow)
    if key in file.kept:
        return file.kept[key]
    if texture is not None and not all(patch.mapped for patch in file.patches):
        raise AssetError(f"{file.name} has no texture coordinates for a texture; unwrap it and export again")
    place = _placement(file, scale, size_m, up, centred)
    shapes = [_placed(patch, *place, two_sided) for patch in file.patches]
    looks = [Material("mesh", picture=texture or patch.picture, glow=glow) for patch in file.patches]
    name = repr((file.digest, scale, size_m, up, centred, two_sided))
    parts = [
        _visible(shape, look, hashlib.sha256(f"{name} {k}".encode()).hexdigest()[:32])
        for k, (shape, look) in enumerate(zip(shapes, looks, strict=True))
    ]
    if solid and collision != "none":
        parts += [_felt(prism, looks[0]) for prism in _prisms(joined(shapes), collision)]
    return file.kept.setdefault(key, Piece(tuple(parts)))


def _placement(
    model: Model, scale: float | None, size_m: Sides | None, up: UpAxis, centred: bool
) -> tuple[FloatArray, FloatArray]:
    """Linear map and shift from the file's axes to the piece's, (3, 3) and (3,)."""
    if scale is not None and size_m is not None:
        raise AssetError("give scale or size_m, not both")
    turn = FROM_Y_UP if up == "y" else np.eye(3)
    points = model.vertices() @ turn.T
    low, high = points.min(axis=0), points.max(axis=0)
    factors = np.full(3, 1.0 if scale is None else scale)
    if size_m is not None:
        wanted = np.array([np.nan if side is None else side for side in size_m], float)
        factors = wanted / np.maximum(high - low, 1e-9)
        given = factors[np.isfinite(factors)]
        if not len(given):
            raise AssetError("size_m must give at least one of length, width, height, got nulls only")
        factors = np.where(np.isfinite(factors), factors, given.min())
        factors = np.where(high - low < 1e-9, given.min(), factors)  # a sheet stays one
    if not (factors > 0).all():
        raise AssetError(f"scale and size_m must be above 0, got {factors.min():g}")
    sides = (high - low) * factors
    if not SMALLEST_M <= sides.max() <= LARGEST_M:
        raise AssetError(
            f"{model.name} must be {SMALLEST_M} to {LARGEST_M:g} m large, got "
            f"{' x '.join(f'{side:.4g}' for side in sides)} m; set scale (0.001 for millimetres) or size_m"
        )
    middle = np.array([*(low + high)[:2] / 2, low[2]]) if centred else np.zeros(3)
    return turn.T * factors, -middle * factors


def _placed(patch: Patch, to_piece: FloatArray, shift: FloatArray, two_sided: bool) -> Mesh:
    vertices = (patch.mesh.vertices @ to_piece + shift).astype(np.float32)
    normals = patch.mesh.normals @ np.linalg.inv(to_piece).T
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    mesh = Mesh(vertices, normals.astype(np.float32), patch.mesh.uvs, patch.mesh.triangles)
    mesh = refined(mesh, GRAIN_M, MOST_FINE)
    return meshes.two_sided(mesh) if two_sided or patch.two_sided else mesh


def _visible(shape: Mesh, look: Material, digest: str) -> Part:
    low, high = shape.vertices.min(axis=0), shape.vertices.max(axis=0)
    middle = (low + high) / 2
    own = Mesh(shape.vertices - middle, shape.normals, shape.uvs, shape.triangles)
    x, y, z = (float(v) for v in middle)
    length, width, height = (float(v) for v in high - low)
    return Part(
        "mesh", (x, y, z), (length, width, height), look, solid=False, tile_m=None,
        casts_shadow=look.glow == 0.0, geometry=Geometry(digest, own),
    )  # fmt: skip


def _prisms(shape: Mesh, collision: Collision) -> list[Prism]:
    points = shape.vertices.astype(float)
    if collision == "convex":
        return prisms_of(points, shape.triangles)
    low, high = points.min(axis=0), points.max(axis=0)
    outline = hull_outline(np.array([(x, y) for x in (low[0], high[0]) for y in (low[1], high[1])]))
    return [Prism(float(low[2]), float(max(high[2], low[2] + SKIN_M)), outline)]


def _felt(prism: Prism, look: Material) -> Part:
    low, high = prism.outline_m.min(axis=0), prism.outline_m.max(axis=0)
    middle = (low + high) / 2
    corners = tuple((round(float(x), 5), round(float(y), 5)) for x, y in prism.outline_m - middle)
    return Part(
        "hull", (float(middle[0]), float(middle[1]), (prism.low_m + prism.high_m) / 2),
        (float(high[0] - low[0]), float(high[1] - low[1]), prism.high_m - prism.low_m),
        look, casts_shadow=False, outline_m=corners,
    )  # fmt: skip
