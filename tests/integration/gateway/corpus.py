"""Broken goal uploads: what is sent, and which refusal is due."""

import io
import struct
import zlib
from dataclasses import dataclass

import numpy as np
from PIL import Image

LIMIT_BYTES = 2_000_000
SIZE = (256, 128)
BOUNDARY = "frontier"
FORM = f"multipart/form-data; boundary={BOUNDARY}"


@dataclass(frozen=True)
class Upload:
    """One request and the due answer: its status and the reason counted in the metrics."""

    name: str
    content_type: str
    body: bytes
    status: int
    reason: str


def saved(image: Image.Image, kind: str, **options: object) -> bytes:
    """A picture as a file."""
    out = io.BytesIO()
    image.save(out, kind, **options)
    return out.getvalue()


def noise(width: int = 256, height: int = 128) -> Image.Image:
    """A picture that does not compress."""
    return Image.fromarray(np.random.default_rng(2).integers(0, 255, (height, width, 3), np.uint8))


def chunk(name: bytes, body: bytes) -> bytes:
    """A PNG chunk."""
    return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))


def bomb(width: int, height: int) -> bytes:
    """A 1-bit PNG that unpacks to far more than it weighs."""
    packer = zlib.compressobj(9)
    row = bytes(1 + (width + 7) // 8)
    body = b"".join(packer.compress(row) for _ in range(height)) + packer.flush()
    header = struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def part(body: bytes, headers: str) -> bytes:
    """One part of a form."""
    return f"--{BOUNDARY}\r\n{headers}\r\n\r\n".encode() + body + b"\r\n"


def form(*parts: bytes) -> bytes:
    """A whole form."""
    return b"".join(parts) + f"--{BOUNDARY}--\r\n".encode()


FILE = (
    'Content-Disposition: form-data; name="picture"; filename="../../etc/passwd"\r\nContent-Type: image/png'
)
FIELD = 'Content-Disposition: form-data; name="picture"'


def broken() -> list[Upload]:
    """Every broken upload."""
    return [*_not_pictures(), *_damaged(), *_sizes(), *_forms()]


def _not_pictures() -> list[Upload]:
    gif = saved(Image.new("P", SIZE), "GIF")
    svg = b'<svg xmlns="http://www.w3.org/2000/svg" width="256" height="128"><script>alert(1)</script></svg>'
    random = np.random.default_rng(3).bytes(50_000)
    return [
        Upload("no bytes", "image/png", b"", 422, "empty"),
        Upload("html as jpeg", "image/jpeg", b"<!doctype html><html></html>", 415, "not_a_picture"),
        Upload("gif", "image/gif", gif, 415, "unsupported_type"),
        Upload("gif as png", "image/png", gif, 415, "not_a_picture"),
        Upload("svg", "image/svg+xml", svg, 415, "unsupported_type"),
        Upload("svg as webp", "image/webp", svg, 415, "not_a_picture"),
        Upload("bmp as png", "image/png", saved(noise(), "BMP"), 415, "not_a_picture"),
        Upload("tiff as jpeg", "image/jpeg", saved(noise(), "TIFF"), 415, "not_a_picture"),
        Upload("random bytes", "image/jpeg", random, 415, "not_a_picture"),
        Upload("no content type", "", saved(noise(), "PNG"), 415, "unsupported_type"),
        Upload("octet stream", "application/octet-stream", saved(noise(), "PNG"), 415, "unsupported_type"),
        Upload("png as jpeg", "image/jpeg", saved(noise(), "PNG"), 415, "type_mismatch"),
        Upload("json", "application/json", b'{"picture": NaN}', 415, "unsupported_type"),
    ]


def _damaged() -> list[Upload]:
    png, jpeg, webp = (saved(noise(), kind) for kind in ("PNG", "JPEG", "WEBP"))
    at = png.index(b"IDAT") + 40
    frames = [Image.new("RGB", SIZE, (shade, 0, 0)) for shade in (0, 120, 240)]
    moving = {"save_all": True, "append_images": frames[1:]}
    return [
        Upload("truncated png", "image/png", png[: len(png) // 2], 422, "damaged"),
        Upload("truncated jpeg", "image/jpeg", jpeg[: len(jpeg) // 2], 422, "damaged"),
        Upload("truncated webp", "image/webp", webp[: len(webp) // 2], 422, "damaged"),
        Upload("png header only", "image/png", png[:33], 422, "damaged"),
        Upload("jpeg start only", "image/jpeg", jpeg[:4], 415, "not_a_picture"),
        Upload(
            "png bad checksum", "image/png", png[:at] + bytes([png[at] ^ 255]) + png[at + 1 :], 422, "damaged"
        ),
        Upload("png without end of data", "image/png", png.replace(b"IDAT", b"JUNK", 1), 422, "damaged"),
        Upload("animated webp", "image/webp", saved(frames[0], "WEBP", **moving), 422, "animated"),
        Upload("animated png", "image/png", saved(frames[0], "PNG", **moving), 422, "animated"),
    ]


def _sizes() -> list[Upload]:
    huge = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 2**31 - 1, 2**30, 8, 2, 0, 0, 0))
    square = saved(noise(199, 199), "JPEG")
    return [
        Upload("bomb of 30000 x 30000", "image/png", bomb(30_000, 30_000), 413, "too_many_pixels"),
        Upload("bomb of 30000 x 15000", "image/png", bomb(30_000, 15_000), 413, "too_many_pixels"),
        Upload("claims 2^31 pixels width", "image/png", huge, 413, "too_many_pixels"),
        Upload("nearly 2:1", "image/jpeg", saved(noise(610, 300), "JPEG"), 422, "not_two_to_one"),
        Upload("a strip", "image/jpeg", saved(noise(900, 300), "JPEG"), 422, "not_two_to_one"),
        Upload("small square", "image/jpeg", square, 422, "too_small"),
        Upload("one pixel", "image/png", saved(noise(1, 1), "PNG"), 422, "too_small"),
        Upload("100000 x 1", "image/png", saved(Image.new("1", (100_000, 1)), "PNG"), 422, "not_two_to_one"),
        Upload("zero width", "image/png", bomb(0, 0), 422, "too_small"),
        Upload("tiny", "image/png", saved(noise(64, 32), "PNG"), 422, "too_small"),
        Upload("too many bytes", "image/png", bytes(LIMIT_BYTES + 1), 413, "body_too_large"),
        Upload("far too many bytes", "image/png", bytes(5 * LIMIT_BYTES), 413, "body_too_large"),
    ]


def _forms() -> list[Upload]:
    png = saved(noise(), "PNG")
    header = "X-Long: " + "a" * 12_000
    typed_text = FILE.replace("image/png", "text/html")
    return [
        Upload("form without parts", FORM, form(), 422, "bad_form"),
        Upload("form with a field only", FORM, form(part(b"hello", FIELD)), 422, "bad_form"),
        Upload("form with two files", FORM, form(part(png, FILE), part(png, FILE)), 422, "bad_form"),
        Upload("form without boundary", "multipart/form-data", form(part(png, FILE)), 422, "bad_form"),
        Upload(
            "form with another boundary", FORM.replace(BOUNDARY, "x"), form(part(png, FILE)), 422, "bad_form"
        ),
        Upload("form cut short", FORM, part(png, FILE)[:-200], 422, "bad_form"),
        Upload("form with a huge header", FORM, form(part(png, f"{FILE}\r\n{header}")), 422, "bad_form"),
        Upload("form with an empty file", FORM, form(part(b"", FILE)), 422, "empty"),
        Upload("form with html", FORM, form(part(b"<html>", typed_text)), 415, "not_a_picture"),
        Upload("form with a wrong type", FORM, form(part(png, typed_text)), 415, "type_mismatch"),
        Upload("form too long", FORM, form(part(bytes(LIMIT_BYTES + 20_000), FILE)), 413, "body_too_large"),
    ]


def convertible() -> list[tuple[str, str, bytes]]:
    """Unusual pictures with a documented conversion."""
    palette = Image.new("P", SIZE, 1)
    rotated = Image.Exif()
    rotated[0x0112] = 6
    return [
        ("cmyk jpeg", "image/jpeg", saved(Image.new("CMYK", SIZE, (0, 99, 99, 0)), "JPEG")),
        ("16-bit png", "image/png", saved(Image.new("I;16", SIZE, 40_000), "PNG")),
        ("palette with alpha", "image/png", saved(palette, "PNG", transparency=1)),
        ("rgba png", "image/png", saved(Image.new("RGBA", SIZE, (9, 9, 9, 9)), "PNG")),
        ("rotated by exif", "image/jpeg", saved(noise(), "JPEG", exif=rotated)),
        ("1-bit png", "image/png", saved(Image.new("1", SIZE, 1), "PNG")),
        ("form with a path as name", FORM, form(part(saved(noise(), "PNG"), FILE))),
    ]
