"""The health check of every container: what it costs, and what it says without a router."""

import resource
import subprocess
import sys

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
