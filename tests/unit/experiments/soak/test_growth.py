"""The slope of memory over time: of one process, of several, and of too little."""

import pytest

from experiments.soak.growth import WARM_UP_S, Sample, growth


def line(service, pid, first_mb, mb_per_h, start_s=0.0, count=20):
    """A process that is measured twice a minute, born at `start_s` with its warm-up."""
    times_s = [start_s + 30.0 * number for number in range(count)]
    return [Sample(service, pid, t, first_mb + mb_per_h * (t - start_s) / 3600.0) for t in times_s]


def test_a_process_that_grows_evenly_has_that_slope():
    assert growth(line("planner", 1, 80.0, 12.0))["planner"].mb_per_h == pytest.approx(12.0)


def test_processes_of_different_size_share_a_slope_and_their_difference_is_none():
    samples = line("drive", 1, 50.0, 6.0) + line("drive", 2, 300.0, 6.0, start_s=700.0)
    found = growth(samples)["drive"]
    assert found.mb_per_h == pytest.approx(6.0)
    assert found.largest_mb > 300.0


def test_the_warm_up_is_no_leak():
    young = [Sample("features", 1, t, 100.0 + t) for t in (0.0, 30.0, 60.0, 90.0)]
    old = [Sample("features", 1, WARM_UP_S + 30.0 * n, 230.0) for n in range(10)]
    found = growth(young + old)["features"]
    assert found.mb_per_h == pytest.approx(0.0)
    assert found.observed_s == 270.0


def test_of_too_little_nothing_is_said():
    found = growth([Sample("router", 1, 0.0, 40.0)])["router"]
    assert (found.mb_per_h, found.observed_s, found.largest_mb) == (None, 0.0, 40.0)
