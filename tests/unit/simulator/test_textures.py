"""Textures: the same seed gives the same picture, another seed another one, tiles tile."""

import numpy as np
import pytest

from simulator.textures.catalogue import KINDS, draw
from simulator.textures.noise import spectral_noise

QUICK = sorted(set(KINDS) - {"boards", "plaster"})


@pytest.mark.parametrize("kind", QUICK)
def test_texture_is_a_picture_that_only_its_seed_decides(kind):
    one = draw(kind, (180, 150, 120), 4)
    assert one.dtype == np.uint8
    assert one.ndim == 3
    assert one.shape[2] == 3
    assert one.std() > 0.5
    np.testing.assert_array_equal(one, draw(kind, (180, 150, 120), 4))


def test_another_seed_gives_another_picture():
    assert (draw("landscape", (0, 0, 0), 1) != draw("landscape", (0, 0, 0), 2)).mean() > 0.5


def test_unknown_kind_lists_the_choices():
    with pytest.raises(ValueError, match=r"one of abstract.*got 'gold'"):
        draw("gold", (1, 2, 3), 0)


def test_noise_tiles_without_a_seam_and_stretches_along_rows(rng):
    field = spectral_noise(rng, 128, 128, 1.5)
    inside = np.abs(np.diff(field, axis=1)).mean()
    assert np.abs(field[:, 0] - field[:, -1]).mean() < 1.5 * inside
    long = spectral_noise(rng, 128, 128, 1.0, stretch=10.0)
    assert np.abs(np.diff(long, axis=1)).mean() < 0.5 * np.abs(np.diff(long, axis=0)).mean()
