"""What a stack leaves on disk."""

import fcntl
import os
import threading

import pytest

from services.launcher.processes.runner import State
from services.launcher.processes.state import AlreadyRunningError, ServiceStatus, StackState, StateFolder


def example(state=State.HEALTHY):
    return StackState(
        launcher_pid=os.getpid(),
        started="2026-01-01T00:00:00Z",
        endpoint="tcp/127.0.0.1:7447",
        gateway_url="http://127.0.0.1:8000",
        map_store_url="http://127.0.0.1:8001",
        logs="logs",
        services={"a": ServiceStatus(state=state, pid=5)},
    )


def test_the_state_of_a_living_launcher_is_found_and_gone_after_it(tmp_path):
    mine = StateFolder(tmp_path)
    assert StateFolder(tmp_path).read() is None
    mine.acquire()
    assert StateFolder(tmp_path).read() is None  # owned, nothing written yet
    mine.write(example())
    assert StateFolder(tmp_path).read() == example()
    mine.release()
    assert StateFolder(tmp_path).read() is None
    assert not StateFolder(tmp_path).owned()


def test_the_file_of_a_killed_launcher_counts_for_nothing(tmp_path):
    mine = StateFolder(tmp_path)
    mine.acquire()
    mine.write(example())
    mine._lock.close()  # what the kernel does when the launcher dies
    next_one = StateFolder(tmp_path)
    assert next_one.read() is None
    next_one.acquire()
    next_one.release()


def test_a_second_launcher_is_told_who_runs(tmp_path):
    mine = StateFolder(tmp_path)
    mine.acquire()
    with pytest.raises(AlreadyRunningError, match=rf"pid {os.getpid()}\): stop it with 'topnav down'"):
        StateFolder(tmp_path).acquire()
    mine.release()


def test_who_looks_is_no_owner_to_others_who_look_and_keeps_nobody_from_becoming_one(tmp_path):
    mine = StateFolder(tmp_path)
    mine.acquire()
    mine.release()
    with (tmp_path / "launcher" / "lock").open("r") as looker:
        fcntl.flock(looker, fcntl.LOCK_SH)
        assert not StateFolder(tmp_path).owned()
        threading.Timer(0.1, fcntl.flock, (looker, fcntl.LOCK_UN)).start()
        mine.acquire()
    assert StateFolder(tmp_path).owned()
    mine.release()


def test_a_stack_is_healthy_when_every_service_is():
    assert example().healthy
    assert not example(State.DEGRADED).healthy
