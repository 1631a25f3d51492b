"""What never moves, ready for the renderer: one lit mesh per material. Pure but for the cache passed in."""

import logging
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from simulator.scene.disk_cache import DiskCache, code_fingerprint, fingerprint
from simulator.scene.lighting import Sunlight, bake
from simulator.scene.mesh_shapes import mesh_of
from simulator.scene.meshes import FloatArray, Mesh, facing_any, joined
from simulator.scene.parts import Light, Material, Part
from simulator.world.world_file import Lighting

log = logging.getLogger(__name__)

CODE = ("curved_shapes.py", "lighting.py", "mesh_shapes.py", "meshes.py", "parts.py", "texturing.py")


@dataclass(frozen=True)
class LitMesh:
    """Triangles of one material and the light at each vertex: (n, 3) factors, see lighting.bake."""

    material: Material
    mesh: Mesh
    light: FloatArray


def by_material(parts: tuple[Part, ...]) -> dict[Material, Mesh]:
    """One mesh per material: few draw calls are what makes frames cheap."""
    groups: dict[Material, list[Mesh]] = {}
    for part in parts:
        groups.setdefault(part.material, []).append(mesh_of(part))
    return {material: joined(shapes) for material, shapes in groups.items()}


def lit_meshes(
    parts: tuple[Part, ...],
    lights: tuple[Light, ...],
    even: Lighting,
    viewpoints: FloatArray,
    cache: DiskCache,
    sun: Sunlight | None = None,
    alike: bool = False,
) -> list[LitMesh]:
    """Meshes of all parts, without what no camera can see, and their light.

    Args:
        parts: all parts, world frame.
        lights: all lamps.
        even: even light of the world.
        viewpoints: (k, 3) positions between which the camera always is.
        cache: keeps the result, as it takes seconds.
        sun: of worlds with open ground.
        alike: whether equal rooms are lit equally, see lighting.bake.
    """
    here = Path(__file__)
    code = code_fingerprint([here, *(here.with_name(name) for name in CODE)])
    key = fingerprint("lit meshes", code, parts, lights, even, viewpoints.tolist(), sun, alike)
    materials = list(dict.fromkeys(part.material for part in parts))
    packed = cache.fetch(key, lambda: _packed(_lit(parts, lights, even, viewpoints, sun, alike), materials))
    return _unpacked(packed, materials)


def _lit(
    parts: tuple[Part, ...],
    lights: tuple[Light, ...],
    even: Lighting,
    viewpoints: FloatArray,
    sun: Sunlight | None,
    alike: bool,
) -> list[LitMesh]:
    log.info("computing the light of %d parts", len(parts))
    culled = {material: facing_any(mesh, viewpoints) for material, mesh in by_material(parts).items()}
    groups = {material: mesh for material, mesh in culled.items() if len(mesh.triangles)}
    whole = joined(list(groups.values()))
    rng = np.random.default_rng(0)
    factors = bake(
        whole.vertices, whole.normals, parts, lights, even.ambient, even.occlusion, rng, sun, alike
    )
    ends = np.cumsum([len(mesh.vertices) for mesh in groups.values()])
    return [
        LitMesh(material, mesh, light)
        for (material, mesh), light in zip(groups.items(), np.split(factors, ends[:-1]), strict=True)
    ]


def _packed(lit: list[LitMesh], materials: list[Material]) -> list[npt.NDArray[Any]]:
    """Eight arrays: index of each mesh's material, numbers of vertices and triangles, then all of these."""
    number = {material: k for k, material in enumerate(materials)}
    shapes = [item.mesh for item in lit]
    return [
        np.array([number[item.material] for item in lit]),
        np.array([len(mesh.vertices) for mesh in shapes]),
        np.array([len(mesh.triangles) for mesh in shapes]),
        np.concatenate([mesh.vertices for mesh in shapes]),
        np.concatenate([mesh.normals for mesh in shapes]),
        np.concatenate([mesh.uvs for mesh in shapes]),
        np.concatenate([mesh.triangles for mesh in shapes]),
        np.concatenate([item.light for item in lit]),
    ]


def _unpacked(arrays: list[npt.NDArray[Any]], materials: list[Material]) -> list[LitMesh]:
    numbers, n_vertices, n_triangles, vertices, normals, uvs, triangles, light = arrays
    corners, faces = np.cumsum(n_vertices)[:-1], np.cumsum(n_triangles)[:-1]
    pieces = zip(
        numbers.tolist(),
        np.split(vertices, corners),
        np.split(normals, corners),
        np.split(uvs, corners),
        np.split(triangles, faces),
        np.split(light, corners),
        strict=True,
    )
    return [LitMesh(materials[k], Mesh(v, n, uv, t), shade) for k, v, n, uv, t, shade in pieces]
