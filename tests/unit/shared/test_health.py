"""The health check of every container: what it costs, and what it says without a router."""

import resource
import subprocess
import sys
import threading
import time

from shared import health
from shared.bus import open_bus

HEAVY = {"pydantic", "numpy", "msgpack", "shared.messages"}


def test_it_imports_neither_messages_nor_what_reads_them():
    code = "import sys, shared.health; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert not HEAVY & set(loaded.split())


def test_it_costs_next_to_nothing_and_names_what_it_did_not_find(monkeypatch, free_port):
    """Seven of them every few seconds took a third of a core."""
    monkeypatch.setenv("TOPNAV_ENDPOINT", f"tcp/127.0.0.1:{free_port()}")
    command = [sys.executable, "-m", "shared.health", "planner"]
    subprocess.run(command, capture_output=True)  # bytecode is there from now on
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    answer = subprocess.run(command, capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert (answer.returncode, answer.stderr[:9]) == (1, "planner: ")
    assert after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime < 0.3, "0.07 s on an idle core"


def test_a_check_begun_too_early_waits_for_its_service_and_says_so_at_once(monkeypatch, router_endpoint):
    """Beside 16 busy loops many short checks took what the simulator needed to start at all."""
    monkeypatch.setenv("TOPNAV_ENDPOINT", router_endpoint)
    monkeypatch.setattr(health, "PATIENCE_S", 60.0)
    answers = []
    check = threading.Thread(target=lambda: answers.append((health.main(["planner"]), time.monotonic())))
    check.start()
    with open_bus(router_endpoint) as bus:
        check.join(timeout=3.0)
        assert answers == [], "nothing is there, and it waits"
        begun_s = time.monotonic()
        bus.announce("planner")
        check.join(timeout=50.0)
    ((code, answered_s),) = answers
    assert code == 0
    assert answered_s - begun_s < 40.0
