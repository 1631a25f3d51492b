"""Somebody floods the bus, or sleeps on it: headings become commands as before, and memory stays bounded."""

import pytest

from experiments.bench.resources import RESIDENT, memory_mb
from tests.faults.latency import Stopwatch, told

pytestmark = [pytest.mark.timeout(300), pytest.mark.usefixtures("patient_sessions")]

PHASE_S, TRIES = 4.0, 5
"""What else runs on this machine only makes it worse: the best of so many counts."""
FLOOD_MB_S = 100.0
FLOODED_S = 0.25
"""A guarantee for a busy machine of two cores; what was measured is in deploy/FAULTS.md."""
SLOW_CONSUMER_S = 0.05
MORE_MB = 60.0
TOLERANCE_S = 0.005
"""The ten per cent below are of a millisecond or two: less than one turn of the scheduler."""


@pytest.fixture
def drive(start_drive):
    return start_drive()


@pytest.fixture
def stopwatch(drive, router_endpoint):  # noqa: ARG001 - drive must run
    with Stopwatch(router_endpoint) as watch:
        assert watch.warm_up()
        yield watch


def test_junk_at_100_mb_a_second_is_thrown_away_unread_and_commands_go_on(
    drive, stopwatch, rogue, record_property
):
    quiet_s, before_mb = stopwatch.latencies_s(PHASE_S), memory_mb(drive.pid, RESIDENT)
    flood = rogue("flood", str(FLOOD_MB_S))
    for _ in range(TRIES):
        figures = told(stopwatch.latencies_s(PHASE_S), "flooded")
        if figures["flooded_p99_ms"] < FLOODED_S * 1e3:
            break
    more_mb, rate = memory_mb(drive.pid, RESIDENT) - before_mb, flood.stdout.readline()
    for name, value in {**told(quiet_s, "quiet"), **figures}.items():
        record_property(name, value)
    record_property("more_mb", round(more_mb, 1))
    record_property("junk_mb_s", float(rate))
    assert figures["flooded_p99_ms"] < FLOODED_S * 1e3
    assert more_mb < MORE_MB


def test_a_subscriber_that_sleeps_does_not_slow_the_others(stopwatch, rogue, record_property):
    quiet = told(stopwatch.latencies_s(PHASE_S), "quiet")  # before any of them: what it does may outlast it
    for _ in range(TRIES):
        figures = quiet | beside_a_sleeper(stopwatch, rogue)
        if not slowed(figures):
            break
    for name, value in figures.items():
        record_property(name, value)
    assert not slowed(figures), figures


def beside_a_sleeper(stopwatch, rogue):
    """Latencies while it sleeps on the bus."""
    sleeper = rogue("sleep")
    beside = told(stopwatch.latencies_s(PHASE_S), "beside")
    sleeper.kill()
    sleeper.wait()
    return beside


def slowed(figures):
    """Whether it slowed anybody down."""
    p50_ms = 1.1 * figures["quiet_p50_ms"] + TOLERANCE_S * 1e3
    p99_ms = max(SLOW_CONSUMER_S * 1e3, 1.5 * figures["quiet_p99_ms"])
    return figures["beside_p50_ms"] > p50_ms or figures["beside_p99_ms"] >= p99_ms
