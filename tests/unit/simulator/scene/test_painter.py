"""Textures through the cache: the same pixels, and a key that changes with whatever decides them."""

import numpy as np
import pytest

from simulator.scene import painter as painter_module
from simulator.scene.disk_cache import DiskCache, code_fingerprint, fingerprint
from simulator.scene.painter import Painter
from simulator.scene.parts import Material
from simulator.textures.catalogue import draw

MATERIALS = [
    Material("metal", (150, 152, 156), 3),
    Material("books", (1, 2, 3), 4),
    Material("clock", seed=9),
]


def paint(folder, materials=MATERIALS):
    with Painter(DiskCache(folder, 10_000_000)) as painter:
        painter.order(materials)
        return [painter.take(material) for material in materials]


def files(folder):
    return {path: path.stat().st_ino for path in folder.iterdir()}


def test_pixels_are_the_same_without_cache_into_it_and_out_of_it(tmp_path):
    drawn = [draw(m.kind, m.colour, m.seed) for m in MATERIALS]
    for pictures in (paint(None), paint(tmp_path), paint(tmp_path)):
        for one, two in zip(drawn, pictures, strict=True):
            assert one.dtype == two.dtype
            np.testing.assert_array_equal(one, two)


def test_a_second_start_draws_nothing(tmp_path, monkeypatch):
    paint(tmp_path)
    before = files(tmp_path)
    monkeypatch.setattr(painter_module, "draw", lambda *_: pytest.fail("drawn again"))
    paint(tmp_path)
    assert files(tmp_path) == before


def test_a_damaged_texture_is_drawn_again(tmp_path):
    (sound,) = paint(tmp_path, MATERIALS[:1])
    (path,) = files(tmp_path)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 255
    path.write_bytes(data)
    np.testing.assert_array_equal(paint(tmp_path, MATERIALS[:1])[0], sound)
    assert path.read_bytes() != data


@pytest.mark.parametrize(
    "other",
    [Material("metal", (150, 152, 157), 3), Material("metal", (150, 152, 156), 4), Material("wicker")],
)
def test_another_kind_colour_or_seed_is_another_entry(tmp_path, other):
    paint(tmp_path, [MATERIALS[0], other])
    assert len(files(tmp_path)) == 2


def test_glow_is_light_and_not_paint(tmp_path):
    paint(tmp_path, [Material("metal"), Material("metal", glow=1.2)])
    assert len(files(tmp_path)) == 1


def test_changed_drawing_code_changes_the_key(tmp_path):
    source = tmp_path / "wood.py"
    source.write_text("GRAIN = 1", encoding="utf-8")
    before = code_fingerprint([source])
    assert code_fingerprint([source]) == before
    source.write_text("GRAIN = 2", encoding="utf-8")
    assert code_fingerprint([source]) != before


def test_parts_of_a_key_do_not_run_into_each_other():
    assert fingerprint("ab", "c") != fingerprint("a", "bc")


def test_an_unknown_kind_is_reported_where_it_is_taken():
    with pytest.raises(ValueError, match="texture kind must be one of"):
        paint(None, [Material("gold")])
