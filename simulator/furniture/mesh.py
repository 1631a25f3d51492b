"""Furniture from a user's model file: glTF or OBJ, with its textures."""

import hashlib
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from pydantic import InstanceOf

from shared.geometry.perspective import rotation_y
from simulator.assets.model import AssetError, Model, Patch, UpAxis
from simulator.assets.model_cache import kept_prisms
from simulator.assets.solids import Outline, prisms
from simulator.scene import meshes
from simulator.scene.meshes import Mesh, refined
from simulator.scene.parts import Geometry, Material, Part, Picture, Piece
from simulator.scene.shapes import hull_part
from simulator.scene.texturing import GRAIN_M

FloatArray = npt.NDArray[np.float64]
FILES = {"file": "model", "texture": "picture", "collision.file": "model"}
"""Options that name files, see catalogue."""
Sides = tuple[float | None, float | None, float | None]
SMALLEST_M, LARGEST_M = 0.005, 100.0
MOST_FINE = 400_000
FROM_Y_UP = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])  # glTF's front, +z, becomes +x


@dataclass(frozen=True)
class Collision:
    """What stops the robot, where it is not the outline of what is seen: a file in the same axes and unit."""

    file: InstanceOf[Model]
    outline: Outline = "convex"


def mesh(
    rng: np.random.Generator,
    file: InstanceOf[Model],
    scale: float | None = None,
    size_m: Sides | None = None,
    up: UpAxis = "y",
    roll_deg: float = 0.0,
    pitch_deg: float = 0.0,
    centred: bool = True,
    solid: bool = True,
    collision: Outline | Collision = "convex",
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
        roll_deg: turn about x, then pitch_deg about y, once it stands as `up` says.
        pitch_deg: positive lowers the front.
        centred: false keeps the origin of the file.
        solid: whether it stops the robot.
        collision: convex outline of each connected piece, concave for walls with rooms between them, sheets
            along all faces, one box, or none; or {file: F, outline: O} for a simpler model in the same place.
        texture: picture file in place of the file's own looks; needs texture coordinates.
        two_sided: shows the backs of open surfaces too.
        glow: above 0 it shines evenly and needs no light.
    """
    del rng
    key = (scale, size_m, up, roll_deg, pitch_deg, centred, solid, collision, texture, two_sided, glow)
    if key in file.kept:
        return file.kept[key]
    if texture is not None and not all(patch.mapped for patch in file.patches):
        raise AssetError(f"{file.name} has no texture coordinates for a texture; unwrap it and export again")
    place = _placement(file, scale, size_m, _standing(up, roll_deg, pitch_deg), centred)
    solids = [_placed(patch, *place) for patch in file.patches]
    name = repr((file.digest, scale, size_m, up, roll_deg, pitch_deg, centred, two_sided))
    looks = [Material("mesh", picture=texture or patch.picture, glow=glow) for patch in file.patches]
    parts = []
    for k, (solid_k, patch) in enumerate(zip(solids, file.patches, strict=True)):
        if patch.seen:
            digest = hashlib.sha256(f"{name} {k}".encode()).hexdigest()[:32]
            parts.append(_visible(_shown(solid_k, two_sided or patch.two_sided), looks[k], digest))
    if isinstance(collision, Collision):
        solids = [_placed(patch, *place) for patch in collision.file.patches]
        felt, outline = collision.file, collision.outline
    else:
        felt, outline = file, collision
    if solid:
        decided_by = (felt.digest, outline, *(one.tolist() for one in place))
        cut = kept_prisms(decided_by, file.cache, lambda: prisms(solids, outline))
        parts += [hull_part(prism, looks[0]) for prism in cut]
    return file.kept.setdefault(key, Piece(tuple(parts)))


def _standing(up: UpAxis, roll_deg: float, pitch_deg: float) -> FloatArray:
    """From the file's axes to those of a piece that stands, (3, 3)."""
    c, s = np.cos(np.radians(roll_deg)), np.sin(np.radians(roll_deg))
    roll = np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]])
    return np.asarray(rotation_y(np.radians(pitch_deg)) @ roll @ (FROM_Y_UP if up == "y" else np.eye(3)))


def _placement(
    model: Model, scale: float | None, size_m: Sides | None, turn: FloatArray, centred: bool
) -> tuple[FloatArray, FloatArray]:
    """Linear map and shift from the file's axes to the piece's, (3, 3) and (3,)."""
    if scale is not None and size_m is not None:
        raise AssetError("give scale or size_m, not both")
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


def _placed(patch: Patch, to_piece: FloatArray, shift: FloatArray) -> Mesh:
    vertices = (patch.mesh.vertices @ to_piece + shift).astype(np.float32)
    normals = patch.mesh.normals @ np.linalg.inv(to_piece).T
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-9)
    return Mesh(vertices, normals.astype(np.float32), patch.mesh.uvs, patch.mesh.triangles)


def _shown(mesh: Mesh, two_sided: bool) -> Mesh:
    mesh = refined(mesh, GRAIN_M, MOST_FINE)
    return meshes.two_sided(mesh) if two_sided else mesh


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
