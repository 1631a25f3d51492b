"""Pictures that meshes name: found where modellers leave them, decoded with bounds, each once."""

import io
from pathlib import Path, PureWindowsPath
from urllib.parse import unquote

import cv2
import numpy as np
from PIL import Image

from simulator.importing.entities import Drawn
from simulator.importing.meshes.surfaces import Pixels
from simulator.textures.catalogue import draw

FORMATS = ("PNG", "JPEG", "WEBP", "TGA", "BMP", "TIFF", "GIF")
MOST_SIDE_PX = 16_384  # untrusted input
KEPT_SIDE_PX = 2048
"""Larger pictures are scaled down; chosen: the camera's picture has as many columns all round."""
BESIDE = (".", "../materials/textures", "../textures", "textures", "materials/textures", "../meshes")
"""Where Gazebo looks for a picture by its name, from a mesh's folder."""
LFS = b"version https://git-lfs"
DRAWN_SEED = 1


class PictureError(ValueError):
    """A picture cannot be used; the message says which and why."""


class Pictures:
    """Reads pictures by the name that a mesh gives them. Keeps what is missing, one line each."""

    def __init__(self) -> None:
        """Nothing is read yet."""
        self._read: dict[Path | Drawn, Pixels] = {}
        self.missing: dict[str, None] = {}

    def named(self, name: str, folder: Path, user: str) -> Pixels | None:
        """A picture that a file in `folder` names; None, and a line in `missing`, where it cannot be used."""
        path = _found(name, folder)
        if path is None:
            self.missing[f"picture {name!r:.160} of {user} is not there: shown in its colour"] = None
            return None
        return self.at(path, user)

    def at(self, source: Path | Drawn, user: str) -> Pixels | None:
        """A picture file, or a texture drawn here; None, and a line in `missing`, where it cannot be used."""
        if source not in self._read:
            try:
                self._read[source] = (
                    np.asarray(draw(source.kind, source.colour, DRAWN_SEED))
                    if isinstance(source, Drawn)
                    else decoded(source.read_bytes(), str(source))
                )
            except (OSError, PictureError) as error:
                self.missing[f"picture of {user} cannot be used: {error!s:.200}"] = None
                return None
        return self._read[source]


def decoded(data: bytes, name: str) -> Pixels:
    """RGB or, where it has holes or glass, RGBA bytes of a picture file; PictureError if it is none."""
    if data.startswith(LFS):
        raise PictureError(f"{name} is a pointer of Git LFS; fetch the file itself with 'git lfs pull'")
    try:
        with Image.open(io.BytesIO(data), formats=FORMATS) as image:
            return pixels_of(image, name)
    except PictureError:
        raise
    except (OSError, ValueError, SyntaxError, EOFError, MemoryError, Image.DecompressionBombError) as error:
        raise PictureError(f"{name} must be one of {', '.join(FORMATS)}: {error!s:.120}") from error


def pixels_of(image: Image.Image, name: str) -> Pixels:
    """RGB or RGBA bytes of an opened picture, at most KEPT_SIDE_PX wide and high."""
    if max(image.size) > MOST_SIDE_PX:
        raise PictureError(f"{name} must be at most {MOST_SIDE_PX} pixels a side, got {image.size}")
    opaque = image.mode in {"RGB", "L", "CMYK", "YCbCr"}
    try:
        pixels = np.ascontiguousarray(image.convert("RGB" if opaque else "RGBA"), np.uint8)
    except (OSError, ValueError, SyntaxError, EOFError, MemoryError) as error:
        raise PictureError(f"{name} is broken: {error!s:.120}") from error
    share = KEPT_SIDE_PX / max(pixels.shape[:2])
    if share < 1.0:
        size = [max(1, round(share * side)) for side in pixels.shape[1::-1]]
        pixels = np.asarray(cv2.resize(pixels, size, interpolation=cv2.INTER_AREA), np.uint8)
    return pixels


def _found(name: str, folder: Path) -> Path | None:
    """By its path from the folder, else by its last part in the folders where textures lie, in any case."""
    plain = unquote(name).removeprefix("file://").replace("\\", "/")
    last = PureWindowsPath(plain).name
    if "\0" in plain or not last:
        return None
    try:
        if (folder / plain).is_file():
            return (folder / plain).resolve()
        for place in BESIDE:
            for path in (folder / place).iterdir() if (folder / place).is_dir() else ():
                if path.name.lower() == last.lower() and path.is_file():
                    return path.resolve()
    except OSError:  # a name too long for the system
        return None
    return None
