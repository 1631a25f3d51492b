"""Pictures as untrusted input: uploaded goals, photos with their EXIF, frames of cameras, textures."""

import io
from pathlib import Path

import numpy as np
from PIL import ExifTags, Image

from services.gateway.uploads.photo import decode_photo, is_photo
from services.gateway.uploads.picture import check_file, check_header, decode_bgr
from services.gateway.uploads.picture_header import HeaderError, read_header
from shared.frames.decoding import decode_picture
from shared.jpeg import BadPictureError
from shared.messages.sensors import Frame
from shared.web.problems import ProblemError
from simulator.assets.model import AssetError
from simulator.assets.picture_file import picture_from_bytes
from tests.fuzz.decoder import Decoder

SIZE = (128, 64)
MODES = {
    "PNG": ("RGB", "RGBA", "P", "L", "LA", "1", "I;16"),
    "JPEG": ("RGB", "L", "CMYK"),
    "WEBP": ("RGB", "RGBA"),
}
TOKENS = {
    "PNG": (
        b"IHDR",
        b"PLTE",
        b"tRNS",
        b"iTXt",
        b"zTXt",
        b"eXIf",
        b"acTL",
        b"fcTL",
        b"fdAT",
        b"IEND",
        b"IDAT",
    ),
    "JPEG": (
        b"\xff\xd8",
        b"\xff\xc0",
        b"\xff\xc2",
        b"\xff\xc4",
        b"\xff\xda",
        b"\xff\xe1Exif\0\0MM",
        b"\xff\xee",
    ),
    "WEBP": (b"VP8X", b"VP8L", b"VP8 ", b"ALPH", b"ANIM", b"ANMF", b"EXIF", b"ICCP"),
}
LARGEST_MB = 330
"""A picture of 64 megapixels may be decoded: the limit that `picture.py` sets."""


def decoders(_scratch: Path) -> list[Decoder]:
    """Per format what the gateway accepts, then what other services read."""
    every = tuple(data for kind in MODES for data in saved(kind))
    tokens = tuple(token for kind in TOKENS.values() for token in kind)
    jpegs = saved("JPEG")
    return [
        *(_goal(kind) for kind in MODES),
        *(_photo(kind) for kind in MODES),
        Decoder("pictures/header", read_header, (HeaderError,), every, tokens),
        Decoder("pictures/frame", _frame, (BadPictureError,), jpegs, TOKENS["JPEG"], memory_mb=LARGEST_MB),
        Decoder("pictures/texture", _texture, (AssetError,), every, tokens, memory_mb=LARGEST_MB, cpu_s=3.0),
    ]


def saved(kind: str) -> tuple[bytes, ...]:
    """Pictures of one format in every mode that it has, and an animation."""
    pixels = np.random.default_rng(4).integers(0, 256, (SIZE[1] // 8, SIZE[0] // 8, 3), np.uint8)
    noise = Image.fromarray(pixels.repeat(8, 0).repeat(8, 1))
    files = []
    for mode in MODES[kind]:
        image = noise.convert("L").convert("I").convert("I;16") if mode == "I;16" else noise.convert(mode)
        files.append(_file(image, kind))
    exif = Image.Exif()
    exif[0x0112] = 6
    files.append(_file(noise, kind, exif=exif))
    if kind == "JPEG":
        files.append(_file(noise, kind, progressive=True))
    else:
        files.append(_file(noise, kind, save_all=True, append_images=[noise.rotate(180)]))
    return tuple(files)


def _file(image: Image.Image, kind: str, **options: object) -> bytes:
    out = io.BytesIO()
    image.save(out, kind, **options)
    return out.getvalue()


def _goal(kind: str) -> Decoder:
    def run(data: bytes) -> None:
        bgr = decode_bgr(data, check_header(data, f"image/{kind.lower()}"))
        assert bgr.dtype == np.uint8
        assert bgr.shape[1] == 2 * bgr.shape[0] <= 2048
        assert bgr.shape[2] == 3

    name = f"pictures/goal-{kind.lower()}"
    return Decoder(name, run, (ProblemError,), saved(kind), TOKENS[kind], cpu_s=5.0, memory_mb=LARGEST_MB)


def _photo(kind: str) -> Decoder:
    def run(data: bytes) -> None:
        header = check_file(data, f"image/{kind.lower()}")
        if not is_photo(header, fov_told=False):
            raise ProblemError(422, "not_two_to_one", "a photo", "another shape", "send a photo")
        photo = decode_photo(data, header, None)
        assert len(photo.data) == 3 * photo.width_px * photo.height_px
        assert photo.view.aspect == photo.width_px / photo.height_px

    name = f"pictures/photo-{kind.lower()}"
    return Decoder(name, run, (ProblemError,), _photos(kind), TOKENS[kind], cpu_s=5.0, memory_mb=LARGEST_MB)


def _photos(kind: str) -> tuple[bytes, ...]:
    """A phone's picture, turned each way, with and without a focal length."""
    pixels = np.random.default_rng(4).integers(0, 256, (30, 40, 3), np.uint8)
    shot = Image.fromarray(pixels.repeat(8, 0).repeat(8, 1))
    files = [_file(shot, kind)]
    for orientation in (3, 6):
        exif = Image.Exif()
        exif[ExifTags.Base.Orientation] = orientation
        exif.get_ifd(ExifTags.IFD.Exif).update(
            {
                ExifTags.Base.FocalLengthIn35mmFilm: 26,
                ExifTags.Base.ExifImageWidth: shot.width,
                ExifTags.Base.ExifImageHeight: shot.height,
            }
        )
        files.append(_file(shot, kind, exif=exif))
    return tuple(files)


def _frame(data: bytes) -> None:
    frame = Frame(robot="r1", encoding="jpeg", width_px=SIZE[0], height_px=SIZE[1], data=data)
    assert decode_picture(frame).shape == (SIZE[1], SIZE[0], 3)


def _texture(data: bytes) -> None:
    assert picture_from_bytes(data, "wall.png").pixels.shape[2] == 3
