"""Models kept on disk as they were read: decoding and parsing again would cost each command seconds."""

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import numpy.typing as npt
import PIL

from simulator.assets.gltf_guard import header_of
from simulator.assets.model import Model, Patch
from simulator.scene import meshes
from simulator.scene.disk_cache import DiskCache, code_fingerprint, fingerprint
from simulator.scene.meshes import Mesh
from simulator.scene.parts import Picture
from simulator.scene.prisms import Prism

Array = npt.NDArray[Any]
QUICK = (cv2.IMWRITE_PNG_COMPRESSION, 1)
"""Packs in a third of the time, a tenth larger."""


def kept_model(name: str, data: bytes, cache: DiskCache, read: Callable[[], Model]) -> Model:
    """The model of a file's content, from the cache if it was read before.

    Args:
        name: of the file.
        data: its content.
        cache: where models are kept.
        read: reads it; raises AssetError if it cannot be used, and nothing is kept.
    """
    if not name.lower().endswith(".glb") or _names_files(data, name):
        return read()  # what other files say cannot be known before it is read
    key = fingerprint("model", _code(), name, data)
    packed = cache.fetch(key, lambda: _packed(read()))
    return _unpacked(name, packed)


def kept_prisms(key: tuple[object, ...], cache: DiskCache, make: Callable[[], list[Prism]]) -> list[Prism]:
    """Prisms by everything that decides them, from the cache if they were cut before."""

    def packed() -> list[Array]:
        prisms = make()
        heights = np.array([(prism.low_m, prism.high_m) for prism in prisms], float).reshape(-1, 2)
        counts = np.array([len(prism.outline_m) for prism in prisms], np.int64)
        outlines = [prism.outline_m for prism in prisms]
        return [heights, counts, np.concatenate(outlines) if outlines else np.zeros((0, 2))]

    heights, counts, corners = cache.fetch(fingerprint("prisms", _code(), *key), packed)
    outlines = np.split(corners, np.cumsum(counts)[:-1]) if len(counts) else []
    return [
        Prism(low_m, high_m, outline)
        for (low_m, high_m), outline in zip(heights.tolist(), outlines, strict=True)
    ]


@lru_cache(maxsize=1)
def _code() -> str:
    """Of everything that reads a model or cuts it."""
    here, scene = Path(__file__).parent, Path(meshes.__file__).parent
    files = [*here.glob("*.py"), scene / "meshes.py", scene / "prisms.py"]
    return fingerprint(code_fingerprint(files), PIL.__version__)


def _names_files(data: bytes, name: str) -> bool:
    header = header_of(data, name)
    named = [*(header.get("images") or ()), *(header.get("buffers") or ())]
    return any("uri" in one for one in named if isinstance(one, dict))


def _packed(model: Model) -> list[Array]:
    """The digest; then of each patch its flags, its picture's digest and PNG, and the four of its mesh."""
    arrays: list[Array] = [np.frombuffer(model.digest.encode(), np.uint8)]
    for patch in model.patches:
        mesh, pixels = patch.mesh, patch.picture.pixels
        code = cv2.COLOR_RGBA2BGRA if pixels.shape[2] == 4 else cv2.COLOR_RGB2BGR
        png = cv2.imencode(".png", cv2.cvtColor(pixels, code), QUICK)[1]
        arrays += [
            np.array([patch.mapped, patch.two_sided, patch.seen]),
            np.frombuffer(patch.picture.digest.encode(), np.uint8),
            np.asarray(png).reshape(-1),
            mesh.vertices,
            mesh.normals,
            mesh.uvs,
            mesh.triangles,
        ]
    return arrays


def _unpacked(name: str, arrays: list[Array]) -> Model:
    patches = []
    for k in range(1, len(arrays), 7):
        flags, digest, png, *mesh = arrays[k : k + 7]
        picture = Picture(digest.tobytes().decode(), _Packed(png))
        mapped, two_sided, seen = flags.tolist()
        patches.append(Patch(Mesh(*mesh), picture, mapped, two_sided, seen))
    return Model(arrays[0].tobytes().decode(), name, tuple(patches))


class _Packed:
    """A picture that is decoded when it is looked at."""

    def __init__(self, png: Array) -> None:
        self._png = png

    def __call__(self) -> npt.NDArray[np.uint8]:
        image = cv2.imdecode(self._png, cv2.IMREAD_UNCHANGED)
        assert image is not None  # the cache has checked the bytes
        code = cv2.COLOR_BGRA2RGBA if image.shape[2] == 4 else cv2.COLOR_BGR2RGB
        return np.asarray(cv2.cvtColor(image, code), np.uint8)
