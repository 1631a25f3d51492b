"""Surfaces -> GLB files, written by trimesh; `assets` reads them as it does anybody's."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from PIL import Image

from simulator.importing.meshes.surfaces import GLASS, Look, Pixels, Surface

GAMMA = 2.2  # of the renderer's textures; colours of glTF are linear


class _Quick(Image.Image):
    """A picture that is packed quickly: a fifth of Pillow's time, a tenth more bytes."""

    @classmethod
    def of(cls, pixels: Pixels) -> "_Quick":
        quick = cls()
        plain = Image.fromarray(pixels)
        quick.__dict__.update(plain.__dict__)
        return quick

    def save(self, fp: Any, format: str | None = None, **params: Any) -> None:
        super().save(fp, format, **{**params, "compress_level": 1})


def glb_of(surfaces: Sequence[Surface]) -> bytes:
    """A GLB file of surfaces, one node each, axes and metres as they are."""
    import trimesh

    scene = trimesh.Scene()
    materials: dict[int, Any] = {}
    for k, surface in enumerate(surfaces):
        material = materials.setdefault(id(surface.look), None) or _material(surface.look)
        materials[id(surface.look)] = material
        visual = trimesh.visual.TextureVisuals(surface.uvs, material)
        if surface.colours is not None:
            visual.vertex_attributes["color"] = _linear_bytes(surface.colours)
        mesh = trimesh.Trimesh(
            surface.vertices, surface.triangles, visual=visual, process=False, validate=False
        )
        scene.add_geometry(mesh, node_name=f"{k} {surface.node}", geom_name=f"{k} {surface.node}")
    return bytes(scene.export(file_type="glb", include_normals=False))


def _material(look: Look) -> Any:
    import trimesh

    rgb = [255.0 * value**GAMMA for value in look.colour[:3]]
    picture = None if look.picture is None else _Quick.of(look.picture)
    holes = look.picture is not None and look.picture.shape[2] == 4
    return trimesh.visual.material.PBRMaterial(
        baseColorFactor=np.round([*rgb, 255.0 * look.colour[3]]).astype(np.uint8),
        baseColorTexture=picture,
        doubleSided=look.two_sided,
        alphaMode="BLEND" if look.colour[3] < GLASS else "MASK" if holes else "OPAQUE",
        metallicFactor=0.0,
        roughnessFactor=1.0,
    )


def _linear_bytes(colours: Pixels) -> Pixels:
    linear = np.round(255.0 * (colours / 255.0) ** GAMMA)
    return np.column_stack([linear, np.full(len(linear), 255.0)]).astype(np.uint8)
