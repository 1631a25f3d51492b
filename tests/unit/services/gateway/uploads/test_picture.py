"""The one conversion of goal pictures, checked on golden pixels, and the refusals."""

import io
import struct
import zlib

import numpy as np
import numpy.typing as npt
import pytest
from PIL import Image

from services.gateway.uploads.picture import check_header, decode_bgr
from shared.web.problems import ProblemError

SIZE = (256, 128)
RED_BGR = [0, 0, 255]


def saved(image: Image.Image, kind: str = "PNG", **options: object) -> bytes:
    out = io.BytesIO()
    image.save(out, kind, **options)
    return out.getvalue()


def decoded(data: bytes, kind: str = "png") -> npt.NDArray[np.uint8]:
    return decode_bgr(data, check_header(data, f"image/{kind}"))


def png16(colour_type: int, samples: list[int]) -> bytes:
    """A 16-bit PNG of one repeated pixel."""

    def chunk(name: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    row = b"\x00" + struct.pack(f">{len(samples)}H", *samples) * SIZE[0]
    header = struct.pack(">IIBBBBB", *SIZE, 16, colour_type, 0, 0, 0)
    body = zlib.compress(row * SIZE[1])
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


def test_channels_come_out_blue_first_and_rows_stay_upright() -> None:
    image = Image.new("RGB", SIZE, (255, 0, 0))
    image.paste((0, 0, 255), (0, 0, 256, 10))
    bgr = decoded(saved(image))
    assert bgr.shape == (128, 256, 3)
    assert bgr.flags.c_contiguous
    assert bgr[127, 0].tolist() == RED_BGR
    assert bgr[0, 0].tolist() == [255, 0, 0]


@pytest.mark.parametrize(
    ("samples", "colour_type", "expected"),
    [
        pytest.param([0x8040], 0, [0x80] * 3, id="grey"),
        pytest.param([0xFF00, 0x8000, 0x0100], 2, [0x01, 0x80, 0xFF], id="rgb"),
        pytest.param([0xFFFF, 0x8000, 0x0100, 0xFFFF], 6, [0x01, 0x80, 0xFF], id="rgba"),
        pytest.param([0x8040, 0xFFFF], 4, [0x80] * 3, id="grey with alpha"),
    ],
)
def test_sixteen_bits_keep_their_high_byte(samples: list[int], colour_type: int, expected: list[int]) -> None:
    assert decoded(png16(colour_type, samples))[64, 128].tolist() == expected


def test_transparency_lies_over_black() -> None:
    image = Image.new("RGBA", SIZE, (255, 0, 0, 0))
    image.paste((255, 0, 0, 255), (0, 0, 128, 128))
    bgr = decoded(saved(image))
    assert bgr[0, 0].tolist() == RED_BGR
    assert bgr[0, 200].tolist() == [0, 0, 0]


def test_a_palette_with_a_transparent_colour_is_looked_up() -> None:
    image = Image.new("P", SIZE, 0)
    image.putpalette([255, 0, 0, 0, 255, 0])
    image.paste(1, (0, 0, 128, 128))
    bgr = decoded(saved(image, transparency=1))
    assert bgr[0, 200].tolist() == RED_BGR
    assert bgr[0, 0].tolist() == [0, 0, 0]


@pytest.mark.parametrize("mode", ["1", "L", "LA"])
def test_grey_fills_all_channels(mode: str) -> None:
    white = {"1": 1, "L": 255, "LA": (255, 255)}[mode]
    assert decoded(saved(Image.new(mode, SIZE, white)))[5, 5].tolist() == [255, 255, 255]  # type: ignore[arg-type]


def test_cmyk_jpegs_are_converted() -> None:
    data = saved(Image.new("CMYK", SIZE, (0, 255, 255, 0)), "JPEG", quality=95)
    np.testing.assert_allclose(decoded(data, "jpeg")[64, 64], RED_BGR, atol=12)


@pytest.mark.parametrize("orientation", [2, 3, 6], ids=["mirrored", "upside down", "on its side"])
@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP"])
def test_exif_rotation_is_ignored(kind: str, orientation: int) -> None:
    image = Image.new("RGB", SIZE, (0, 0, 255))
    image.paste((255, 0, 0), (0, 0, 128, 64))
    exif = Image.Exif()
    exif[0x0112] = orientation
    bgr = decoded(saved(image, kind, exif=exif), kind.lower())
    assert bgr.shape == (128, 256, 3)
    np.testing.assert_allclose(bgr[20, 20], RED_BGR, atol=12)
    np.testing.assert_allclose(bgr[100, 200], [255, 0, 0], atol=12)


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP"])
def test_large_pictures_shrink_to_2048_and_keep_their_average(kind: str) -> None:
    pixels = np.zeros((1040, 2080, 3), np.uint8)
    pixels[:, ::2] = 200
    bgr = decoded(saved(Image.fromarray(pixels), kind), kind.lower())
    assert bgr.shape == (1024, 2048, 3)
    assert abs(float(bgr.mean()) - 100.0) < 3.0


@pytest.mark.parametrize("mode", ["RGB", "RGBA", "P", "L", "1"])
@pytest.mark.parametrize("width", [2050, 3998])
def test_shrinking_in_bands_gives_what_shrinking_at_once_gives(mode: str, width: int) -> None:
    rng = np.random.default_rng(8)
    grey = Image.fromarray(rng.integers(0, 255, (width // 2, width), np.uint8))
    image = grey.convert("RGB").convert(mode)
    expected = image.convert("RGB").resize((2048, 1024), Image.Resampling.BOX)
    got = decoded(saved(image, compress_level=1))[:, :, ::-1].astype(int)
    assert np.abs(got - np.asarray(expected, int)).max() <= 1


def test_a_jpeg_of_very_many_scans_is_refused_unread() -> None:
    data = saved(Image.new("RGB", SIZE), "JPEG", progressive=True)
    at = data.rindex(b"\xff\xda")
    assert check_header(data, "image/jpeg").width_px == SIZE[0]
    with pytest.raises(ProblemError) as caught:
        check_header(data[:at] + data[at:-2] * 200 + data[-2:], "image/jpeg")
    assert (caught.value.status_code, caught.value.code) == (422, "too_many_scans")


@pytest.mark.parametrize(
    ("kind", "size", "fits"),
    [("png", (8192, 4096), True), ("png", (8320, 4160), False), ("jpeg", (11_008, 5504), True)],
)
def test_only_jpegs_may_be_of_64_megapixels(kind: str, size: tuple[int, int], fits: bool) -> None:
    data = saved(Image.new("1", size), kind.upper())
    if fits:
        assert check_header(data, f"image/{kind}")[1:] == size
        return
    with pytest.raises(ProblemError) as caught:
        check_header(data, f"image/{kind}")
    assert (caught.value.status_code, caught.value.code) == (413, "too_many_pixels")


@pytest.mark.parametrize(
    ("size", "reason"),
    [((1, 1), "not_two_to_one"), ((100_000, 1), "not_two_to_one"), ((300, 128), "not_two_to_one")],
)
def test_shapes_that_are_no_panorama_are_refused(size: tuple[int, int], reason: str) -> None:
    with pytest.raises(ProblemError) as caught:
        check_header(saved(Image.new("1", size)), "image/png")
    assert caught.value.code == reason


def test_a_tiny_panorama_is_refused() -> None:
    with pytest.raises(ProblemError) as caught:
        check_header(saved(Image.new("1", (126, 63))), "image/png")
    assert caught.value.code == "too_small"


def test_the_declared_type_must_fit() -> None:
    with pytest.raises(ProblemError) as caught:
        check_header(saved(Image.new("1", SIZE)), "image/jpeg")
    assert (caught.value.status_code, caught.value.code) == (415, "type_mismatch")


@pytest.mark.parametrize("kind", ["PNG", "WEBP"])
def test_animations_are_refused(kind: str) -> None:
    frames = [Image.new("RGB", SIZE, (shade, 0, 0)) for shade in (0, 99, 200)]
    data = saved(frames[0], kind, save_all=True, append_images=frames[1:])
    with pytest.raises(ProblemError) as caught:
        decoded(data, kind.lower())
    assert caught.value.code == "animated"


@pytest.mark.parametrize("kind", ["PNG", "JPEG", "WEBP"])
def test_a_picture_cut_short_is_damaged_wherever_it_is_cut(kind: str) -> None:
    rng = np.random.default_rng(5)
    data = saved(Image.fromarray(rng.integers(0, 255, (128, 256, 3), np.uint8)), kind)
    for part in (0.1, 0.5, 0.9):
        with pytest.raises(ProblemError) as caught:
            decoded(data[: int(len(data) * part)], kind.lower())
        assert caught.value.status_code in (415, 422)


def test_a_wrong_checksum_is_damaged() -> None:
    data = bytearray(saved(Image.new("RGB", SIZE, (9, 9, 9))))
    at = data.index(b"IDAT")
    data[at + 12] ^= 0xFF
    with pytest.raises(ProblemError) as caught:
        decoded(bytes(data))
    assert caught.value.code == "damaged"


def test_flipped_bytes_never_escape_as_another_error() -> None:
    rng = np.random.default_rng(11)
    pixels = Image.fromarray(rng.integers(0, 255, (64, 128, 3), np.uint8))
    for kind in ("PNG", "JPEG", "WEBP"):
        good = saved(pixels, kind)
        for _ in range(60):
            data = bytearray(good)
            for at in rng.integers(0, len(data), 4):
                data[at] = rng.integers(0, 256)
            try:
                bgr = decoded(bytes(data), kind.lower())
            except ProblemError:
                continue
            assert bgr.shape[1] == 2 * bgr.shape[0]
