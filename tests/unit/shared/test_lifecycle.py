"""Life of a service: JSON logs, signals as an event, and a bus that closes whatever the loop does."""

import json
import logging
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from shared.bus import wait_until
from shared.lifecycle import STOPPING, JsonFormatter, in_thread, stop_on_signals

SOON_S = 60.0

SERVICE = """
import sys
from shared.lifecycle import run_service
from shared.settings import ServiceSettings
from shared.topics import VELOCITY

def loop(bus, stop):
    bus.subscribe(VELOCITY, robot="*")
    bus.watch_alive(lambda *_: None)
    bus.announce("drive")
    print("ready", flush=True)
    if "fail" in sys.argv:
        raise RuntimeError("broken")
    stop.wait(60)

run_service("drive", ServiceSettings.from_environment(), loop)
"""


def start(repository: Path, endpoint: str, *arguments: str) -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", SERVICE, *arguments],
        cwd=repository,
        env=os.environ | {"TOPNAV_ENDPOINT": endpoint},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


def test_a_log_record_is_one_line_of_json():
    record = logging.LogRecord("drive", logging.WARNING, "x.py", 1, "two\nlines %d", (5,), None)
    line = JsonFormatter("drive").format(record)
    assert "\n" not in line
    entry = json.loads(line)
    assert (entry["level"], entry["service"], entry["text"]) == ("WARNING", "drive", "two\nlines 5")
    assert entry["time"].endswith("Z")


def test_errors_are_logged_with_their_traceback():
    try:
        raise ValueError("broken")
    except ValueError:
        record = logging.LogRecord("drive", logging.ERROR, "x.py", 1, "failed", (), sys.exc_info())
    assert "ValueError: broken" in json.loads(JsonFormatter("drive").format(record))["error"]


@pytest.fixture
def stop() -> Iterator[threading.Event]:
    before = {number: signal.getsignal(number) for number in STOPPING}
    yield stop_on_signals()
    signal.set_wakeup_fd(-1)
    for number, handler in before.items():
        signal.signal(number, handler)


def test_a_signal_sets_the_event_even_in_the_middle_of_waiting_for_it(stop: threading.Event):
    with stop._cond:  # as it is for a moment inside stop.wait
        os.kill(os.getpid(), signal.SIGTERM)
    assert stop.wait(SOON_S)


@pytest.mark.parametrize("number", STOPPING)
def test_a_signal_that_does_not_interrupt_the_wait_ends_it(stop: threading.Event, number: signal.Signals):
    """As one that comes just before the main thread blocks: blocked there, another thread receives it."""
    threading.Timer(0.2, os.kill, (os.getpid(), number)).start()
    signal.pthread_sigmask(signal.SIG_BLOCK, [number])
    try:
        assert stop.wait(SOON_S)
    finally:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, [number])


def test_other_signals_stop_nothing(stop: threading.Event):
    before = signal.signal(signal.SIGUSR1, lambda *_: None)
    try:
        os.kill(os.getpid(), signal.SIGUSR1)
        assert not stop.wait(0.3)
    finally:
        signal.signal(signal.SIGUSR1, before)


@pytest.mark.parametrize("number", STOPPING)
def test_a_service_with_callbacks_stops_cleanly_on_a_signal(
    repository: Path, router_endpoint: str, number: signal.Signals
):
    with start(repository, router_endpoint) as child:
        assert child.stdout is not None
        assert child.stdout.readline() == "ready\n"
        child.send_signal(number)
        _, errors = child.communicate(timeout=SOON_S)
    assert child.returncode == 0
    assert [json.loads(line)["text"] for line in errors.splitlines()][-1] == "stopped"


def test_a_loop_that_fails_ends_the_process_instead_of_hanging_it(repository: Path, router_endpoint: str):
    with start(repository, router_endpoint, "fail") as child:
        _, errors = child.communicate(timeout=SOON_S)
    assert child.returncode == 1
    assert "RuntimeError: broken" in errors


def test_what_is_done_beside_a_block_ends_with_it():
    heard = []
    with in_thread(lambda stop: heard.append(stop.wait(10.0)), "beside") as check:
        check()
    assert heard == [True]


def test_what_fails_beside_a_block_is_told_to_who_asks_and_at_the_end():
    failed = threading.Event()

    def fail(_stop: threading.Event) -> None:
        failed.set()
        raise LookupError("no such map")

    with pytest.raises(LookupError, match="no such map"), in_thread(fail, "beside"):
        assert failed.wait(10.0)
    with pytest.raises(LookupError), in_thread(fail, "beside") as check:
        wait_until(lambda: check() is not None, 10.0)
