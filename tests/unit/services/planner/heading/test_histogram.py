"""Polar histogram: 18 sectors of 20 degrees, method 4 from nine empty neighbours on."""

import numpy as np
import pytest

from services.planner.heading.histogram import longest_empty_run, method_by_histogram, polar_histogram
from tests.unit.services.planner.heading.scenes import deg


def in_sectors(*sectors):
    return deg(*[(-180.0 + 20.0 * k + 10.0, 5.0) for k in sectors])


@pytest.mark.parametrize(
    ("lon_deg", "sector"), [(-180, 0), (-160.001, 0), (-160, 1), (0, 9), (179.9, 17), (180, 0)]
)
def test_sector_of_known_longitude(lon_deg, sector):
    assert np.argmax(polar_histogram(deg((lon_deg, 0.0)))) == sector


def test_every_match_is_counted_once():
    lon = np.random.default_rng(0).uniform(-np.pi, np.pi, 500)
    counts = polar_histogram(np.stack([lon, 0 * lon], axis=1))
    assert (len(counts), counts.sum()) == (18, 500)


@pytest.mark.parametrize(
    ("sectors", "run"),
    [
        ((0,), 17),
        ((0, 9), 8),
        ((0, 10), 9),
        ((4, 5, 6, 7, 8, 9, 10, 11, 12), 9),
        (tuple(range(18)), 0),
        ((), 18),
    ],
)
def test_longest_run_is_circular(sectors, run):
    assert longest_empty_run(polar_histogram(in_sectors(*sectors))) == run


@pytest.mark.parametrize(
    ("sectors", "method"),
    [
        pytest.param((0, 10), "4", id="nine empty"),
        pytest.param((0, 9), "1", id="eight empty on both sides"),
        pytest.param((4, 5, 6, 7, 8, 9, 10, 11, 12), "4", id="nine empty across the seam"),
        pytest.param((3, 4, 5, 6, 7, 8, 9, 10, 11, 12), "1", id="eight empty across the seam"),
    ],
)
def test_half_a_turn_without_matches_means_method_4(sectors, method):
    assert method_by_histogram(in_sectors(*sectors)) == method
