"""What a stack leaves on disk."""

import fcntl
import os
import subprocess
import threading
import time

import pytest
from pydantic import ValidationError

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
        services={"a": ServiceStatus(state=state, pid=os.getpid())},
    )


def test_the_state_of_a_living_launcher_is_found_and_gone_after_it(tmp_path):
    mine = StateFolder(tmp_path)
    assert StateFolder(tmp_path).read() is None
    mine.acquire()
    assert StateFolder(tmp_path).read() is None  # owned, nothing written yet
    mine.write(example())
    assert StateFolder(tmp_path).read().model_copy(update={"silent_s": 0.0}) == example()
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


def test_what_a_killed_launcher_left_is_not_taken_for_that_of_the_next(tmp_path):
    """Its process id may be an innocent process's by now, and `topnav down` would kill that."""
    with subprocess.Popen(["sleep", "600"]) as innocent:
        mine = StateFolder(tmp_path)
        mine.acquire()
        left = example().model_copy(update={"launcher_pid": innocent.pid})
        mine.write(left)
        (tmp_path / "launcher" / "lock").write_text(str(innocent.pid))
        assert StateFolder(tmp_path).owner() == os.getpid(), "as the kernel knows it"
        assert StateFolder(tmp_path).read() is None
        mine.release()
        assert StateFolder(tmp_path).owner() is None
        mine.write(left)
        mine.acquire()
        assert not (tmp_path / "launcher" / "state.json").exists()
        mine.release()
        innocent.kill()


def test_a_service_whose_process_is_gone_is_not_told_as_healthy(tmp_path):
    """Whatever stands in the file of a launcher that cannot write, or that was stopped itself."""
    child = subprocess.Popen(["true"])
    os.waitid(os.P_PID, child.pid, os.WEXITED | os.WNOWAIT)  # dead and not reaped
    mine = StateFolder(tmp_path)
    mine.acquire()
    mine.write(
        example().model_copy(update={"services": {"a": ServiceStatus(state="healthy", pid=child.pid)}})
    )
    seen = StateFolder(tmp_path).read()
    assert (seen.services["a"].state, seen.services["a"].pid, seen.healthy) == (State.EXITED, None, False)
    child.wait()
    mine.release()


def test_a_launcher_that_says_nothing_is_told_as_silent(tmp_path):
    mine = StateFolder(tmp_path)
    mine.acquire()
    mine.write(example())
    file = tmp_path / "launcher" / "state.json"
    os.utime(file, (time.time() - 60.0,) * 2)
    seen = StateFolder(tmp_path).read()
    assert (seen.silent, seen.healthy) == (True, False)
    mine.beat()
    assert StateFolder(tmp_path).read().healthy
    mine.release()


@pytest.mark.parametrize("pid", [1, 0, -1])
def test_no_launcher_has_such_a_process_id(pid):
    with pytest.raises(ValidationError):
        StackState.model_validate(example().model_dump() | {"launcher_pid": pid})


def test_a_stack_is_healthy_when_every_service_is():
    assert example().healthy
    assert not example(State.DEGRADED).healthy
