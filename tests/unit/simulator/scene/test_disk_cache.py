"""Arrays on disk: kept, checked, replaced when damaged, bounded, and no worse than nothing when unusable."""

import logging
import os
import subprocess
import sys
import tempfile

import numpy as np
import pytest

from simulator.scene import disk_cache
from simulator.scene.disk_cache import ABANDONED_S, PARTIAL, SUFFIX, DiskCache

KEY, OTHER = "a1" * 32, "b2" * 32
LIMIT = 1_000_000


@pytest.fixture
def cache(tmp_path):
    return DiskCache(tmp_path / "cache", LIMIT)


class Maker:
    """Makes two arrays and counts how often."""

    def __init__(self, value=7):
        self.value, self.made = value, 0

    def __call__(self):
        self.made += 1
        return [np.full((4, 5, 3), self.value, np.uint8), np.arange(6, dtype=np.float32).reshape(2, 3).T]


def only_file(cache):
    (path,) = cache._folder.iterdir()
    return path


def age(path, seconds):
    stamp = path.stat().st_mtime - seconds
    os.utime(path, (stamp, stamp))


def test_what_was_made_once_is_read_back_equal_in_type_shape_and_bytes(cache):
    maker = Maker()
    fresh = cache.fetch(KEY, maker)
    kept = cache.fetch(KEY, maker)
    assert maker.made == 1
    for one, two in zip(fresh, kept, strict=True):
        assert (one.dtype, one.shape) == (two.dtype, two.shape)
        np.testing.assert_array_equal(one, two)


def test_empty_and_single_values_are_kept_too(cache):
    arrays = [np.zeros((0, 3), np.float32), np.array(3)]
    cache.fetch(KEY, lambda: arrays)
    assert [(a.shape, a.dtype) for a in cache.fetch(KEY, list)] == [(a.shape, a.dtype) for a in arrays]


def test_another_process_finds_it(cache):
    cache.fetch(KEY, Maker())
    code = (
        "import pathlib, sys; from simulator.scene.disk_cache import DiskCache;"
        "print(DiskCache(pathlib.Path(sys.argv[1]), 1000).fetch(sys.argv[2], sys.exit)[0].sum())"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, str(cache._folder), KEY], capture_output=True, text=True, check=True
    )
    assert int(run.stdout) == 4 * 5 * 3 * 7


def cut_short(data):
    return data[: len(data) // 2]


def one_bit_wrong(data):
    return data[:150] + bytes([data[150] ^ 1]) + data[151:]


def longer(data):
    return data + b"\0"


def empty(data):
    del data
    return b""


def something_else(data):
    del data
    return b"\x89PNG\r\n\x1a\n" + bytes(500)


@pytest.mark.parametrize("damage", [cut_short, one_bit_wrong, longer, empty, something_else])
def test_a_damaged_entry_is_made_anew_and_replaced(cache, caplog, damage):
    sound = cache.fetch(KEY, Maker())
    path = only_file(cache)
    data = path.read_bytes()
    path.write_bytes(damage(data))
    maker = Maker()
    np.testing.assert_array_equal(cache.fetch(KEY, maker)[0], sound[0])
    assert maker.made == 1
    assert "damaged or not ours" in caplog.text
    assert path.read_bytes() == data


def test_an_entry_under_another_ones_name_is_not_believed(cache):
    cache.fetch(KEY, Maker(value=1))
    only_file(cache).rename(cache._folder / (OTHER + SUFFIX))
    assert cache.fetch(OTHER, Maker(value=2))[0].max() == 2


def test_a_process_killed_while_writing_leaves_no_entry(cache, monkeypatch):
    class Killed(BaseException):
        pass

    def die(*_):
        raise Killed

    with monkeypatch.context() as patch:
        patch.setattr("pathlib.Path.replace", die)
        with pytest.raises(Killed):
            cache.fetch(KEY, Maker())
    left = only_file(cache)
    assert left.suffix == PARTIAL
    maker = Maker()
    cache.fetch(KEY, maker)
    assert maker.made == 1
    cache.tidy()
    assert left.exists()  # it may belong to a process that is writing now
    age(left, ABANDONED_S + 1)
    cache.tidy()
    assert not left.exists()


def test_tidying_drops_what_was_used_longest_ago_until_the_rest_fits_and_touches_nothing_else(tmp_path):
    cache = DiskCache(tmp_path, 2500)
    stranger = tmp_path / "notes.txt"
    stranger.write_bytes(bytes(10_000))
    keys = [f"{k:02x}" * 32 for k in range(4)]
    for k, key in enumerate(keys):
        cache.fetch(key, lambda: [np.zeros(1000 - 160, np.uint8)])
        age(tmp_path / (key + SUFFIX), 100 - k)
    cache.fetch(keys[0], list)  # used again: now the newest
    cache.tidy()
    left = {path.stem for path in tmp_path.glob(f"*{SUFFIX}")}
    assert left == {keys[0], keys[3]}
    assert stranger.exists()


def of_the_cache(caplog):
    """Records of the cache: threads of earlier tests may still warn, too."""
    return [record for record in caplog.records if record.name == disk_cache.__name__]


def test_a_folder_that_cannot_be_used_gives_one_warning_and_everything_is_made(tmp_path, caplog):
    (tmp_path / "file").write_text("in the way", encoding="utf-8")
    cache = DiskCache(tmp_path / "file" / "cache", LIMIT)
    for key in (KEY, OTHER, KEY):
        assert cache.fetch(key, Maker(value=3))[0].max() == 3
    cache.tidy()
    warnings = [record for record in of_the_cache(caplog) if record.levelno >= logging.WARNING]
    assert len(warnings) == 1
    assert "cannot be used" in warnings[0].getMessage()


def test_a_full_or_read_only_disk_gives_one_warning_and_what_is_there_is_still_read(
    cache, caplog, monkeypatch
):
    cache.fetch(KEY, Maker(value=1))

    def refuse(*_args, **_options):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(tempfile, "NamedTemporaryFile", refuse)
    for _ in range(2):
        assert cache.fetch(OTHER, Maker(value=2))[0].max() == 2
    assert cache.fetch(KEY, Maker(value=9))[0].max() == 1
    assert [record.levelno for record in of_the_cache(caplog)] == [logging.WARNING]


def test_without_a_folder_everything_is_made_and_nothing_written():
    maker, cache = Maker(), DiskCache(None, LIMIT)
    cache.fetch(KEY, maker)
    cache.fetch(KEY, maker)
    cache.tidy()
    assert maker.made == 2
