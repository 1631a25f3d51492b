"""Robots of one place in lockstep stay within two frames of each other, and wait for nobody who stands."""

import pytest

from simulator.pace import AHEAD_S, PATIENCE_S, Pace

PERIOD_S = 0.3


@pytest.fixture
def pace():
    """Beside one other, heard at its time 0."""
    beside = Pace()
    beside.heard("r2", 0, 0.0)
    return beside


def test_alone_nobody_is_waited_for():
    alone = Pace()
    for _ in range(100):
        alone.passed(PERIOD_S)
    assert not alone.is_ahead(1.0)


def test_two_frames_ahead_of_another_it_waits_until_that_one_goes_on(pace):
    pace.passed(PERIOD_S)
    assert not pace.is_ahead(1.0)
    pace.passed(PERIOD_S)
    assert pace.is_ahead(1.0)
    pace.heard("r2", 0, 1.5)  # its frame again
    assert pace.is_ahead(1.5)
    pace.heard("r2", 300_000_000, 2.0)
    assert not pace.is_ahead(2.0)


def test_whose_time_stands_is_not_waited_for(pace):
    for _ in range(3):
        pace.passed(PERIOD_S)
    assert pace.is_ahead(PATIENCE_S - 0.1)
    assert not pace.is_ahead(PATIENCE_S + 0.1)


def test_who_was_not_waited_for_keeps_nobody_for_long_and_is_not_kept(pace):
    for _ in range(1000):
        pace.passed(PERIOD_S)
    pace.heard("r2", 300_000_000, 400.0)
    assert not pace.is_ahead(400.0)
    pace.heard("r2", 600_000_000_000, 500.0)  # it ran on alone
    steps = 0
    while not pace.is_ahead(500.0):
        pace.passed(PERIOD_S)
        steps += 1
    assert steps * PERIOD_S <= 2 * AHEAD_S + PERIOD_S


def test_who_is_gone_is_not_waited_for(pace):
    for _ in range(3):
        pace.passed(PERIOD_S)
    pace.gone("r2")
    assert not pace.is_ahead(1.0)
    pace.heard("r2", 5, 2.0)
    assert not pace.is_ahead(2.0)


def test_the_slowest_of_several_counts(pace):
    pace.heard("r3", 7, 0.0)
    for turn in range(1, 4):
        pace.passed(PERIOD_S)
        pace.heard("r2", turn * 300_000_000, 0.1 * turn)
    assert pace.is_ahead(0.4)
