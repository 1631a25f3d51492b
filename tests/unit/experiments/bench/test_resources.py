"""Processor time of processes is read as the system counts it."""

import subprocess
import sys
import time
from types import SimpleNamespace

import pytest

from experiments.bench.resources import ServiceTimes, processor_s, processors_s
from shared.bus import wait_until

BUSY = "while True: pass"


@pytest.fixture
def busy():
    """A process that computes, whatever its name."""
    child = subprocess.Popen([sys.executable, "-c", BUSY])
    yield child
    child.kill()
    child.wait()


def test_a_process_that_computes_takes_processor_time(busy):
    assert wait_until(lambda: (processor_s(busy.pid) or 0.0) > 0.1, 60.0)


def test_a_process_that_is_gone_counts_nothing(busy):
    busy.kill()
    busy.wait()
    assert processor_s(busy.pid) is None
    assert processors_s([busy.pid]) == 0.0


def test_services_are_told_apart_and_one_that_restarted_is_left_out(busy):
    statuses = {"drive": SimpleNamespace(pid=busy.pid), "planner": SimpleNamespace(pid=None)}
    began_s = time.monotonic()
    times = ServiceTimes(SimpleNamespace(status=lambda: statuses))
    made_s, before_s = time.monotonic(), processor_s(busy.pid)
    assert wait_until(lambda: processor_s(busy.pid) > before_s + 0.1, 60.0)
    asked_s = time.monotonic()
    figures = times.figures(steps=10)
    longest_s, shortest_s = time.monotonic() - began_s, asked_s - made_s
    assert figures.keys() == {"drive"}
    spent_s = figures["drive"]["ms_per_step"] * 10 / 1e3
    assert 0.1 <= spent_s <= longest_s + 0.02  # counted in hundredths, of user and of system
    assert 0.99 * spent_s / longest_s <= figures["drive"]["cores"] <= 1.01 * spent_s / shortest_s
    statuses["drive"] = SimpleNamespace(pid=1)
    assert times.figures(steps=10) == {}


def test_a_stack_that_somebody_else_runs_has_no_figures():
    assert ServiceTimes(None).figures(steps=10) == {}
