"""The launcher with small real processes: crashes, kills, stops, and nothing left behind."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from services.launcher.processes import process
from services.launcher.processes.restart import RestartPolicy
from services.launcher.processes.runner import State
from services.launcher.processes.running import variables_with_dotenv
from services.launcher.processes.state import AlreadyRunningError, StateFolder
from services.launcher.processes.supervisor import Launcher
from services.launcher.processes.wait import LaunchError
from shared.bus import wait_until
from tests.integration.launcher.returning import kills_until_it_is_back_in_time

QUICK = RestartPolicy(first_s=0.05, longest_s=0.1, storm_exits=3, settle_s=0.2)
SOON_S = 60.0
NEVER = {"test": ["CMD", "false"], "interval": "50ms"}
"""Of what ends at its start: without a health check it is healthy if that takes half a second or more."""
SLEEP = [sys.executable, "-c", "import time; time.sleep(600)"]
STUBBORN = "import signal, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); print('up'); time.sleep(600)"
PARENT = "import subprocess, time; print(subprocess.Popen(['sleep', '600']).pid, flush=True); time.sleep(600)"


def compose(tmp_path, **services):
    """Write a Compose file; each service is a dict, or the words of a command."""
    entries = {
        name: {"restart": "unless-stopped", **(entry if isinstance(entry, dict) else {"command": entry})}
        for name, entry in services.items()
    }
    path = tmp_path / "docker-compose.yml"
    path.write_text(json.dumps({"services": entries}), encoding="utf-8")  # JSON is YAML
    return path


def gone(pid):
    """Whether a process is no more; one that nobody has reaped yet counts as gone."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
    except (FileNotFoundError, ProcessLookupError):
        return True


@pytest.fixture
def launch(tmp_path):
    """Start a launcher on a made-up Compose file."""
    launchers = []

    def start(policy=QUICK, wait=True, **services):
        launcher = Launcher(
            tmp_path / "data", compose_file=compose(tmp_path, **services), policy=policy, timeout_s=SOON_S
        )
        launchers.append(launcher)
        launcher.start(wait=wait)
        return launcher

    yield start
    for launcher in launchers:
        launcher.stop()


def test_a_killed_service_is_back_within_five_seconds_and_the_others_never_notice(launch):
    stack = launch(policy=RestartPolicy(), a=SLEEP, b=SLEEP)
    other = stack.pid("b")
    kills = kills_until_it_is_back_in_time(stack, "a")
    assert stack.pid("b") == other
    assert stack.status()["a"].restarts == kills
    assert stack.status()["a"].last_exit == -signal.SIGKILL


def test_a_crash_loop_is_degraded_and_the_rest_survives(launch):
    stack = launch(wait=False, bad=[sys.executable, "-c", "raise SystemExit(3)"], good=SLEEP)
    assert wait_until(lambda: stack.status()["bad"].state is State.DEGRADED, SOON_S)
    restarts = stack.status()["bad"].restarts
    assert wait_until(lambda: stack.status()["bad"].restarts > restarts, SOON_S), "it must go on trying"
    assert stack.status()["bad"].last_exit == 3
    stack.wait_healthy("good", SOON_S)
    assert stack.status()["good"].restarts == 0


def test_a_stack_that_cannot_start_says_why_and_leaves_nothing(tmp_path):
    bad = [sys.executable, "-c", "raise SystemExit('no camera at /dev/video7')"]
    path = compose(tmp_path, good=SLEEP, bad={"command": bad, "healthcheck": NEVER})
    launcher = Launcher(tmp_path / "data", compose_file=path, policy=QUICK, timeout_s=SOON_S)
    with pytest.raises(
        LaunchError, match=r"bad keeps ending \(exit 1\): no camera at /dev/video7 \(see .*bad.jsonl\)"
    ):
        launcher.start()
    assert all(status.pid is None for status in launcher.status().values())
    assert not StateFolder(tmp_path / "data").owned()


def test_services_start_in_order_and_wait_for_health(launch, tmp_path):
    flag = tmp_path / "ready"
    check = {"test": ["CMD", "test", "-e", str(flag)], "interval": "50ms"}
    first = {"command": SLEEP, "healthcheck": check}
    second = {"command": SLEEP, "depends_on": {"first": {"condition": "service_healthy"}}}
    stack = launch(wait=False, second=second, first=first)
    assert wait_until(lambda: stack.status()["first"].state is State.STARTING, SOON_S)
    assert stack.status()["second"].state is State.WAITING
    flag.touch()
    stack.wait_all_healthy(SOON_S)
    flag.unlink()
    assert wait_until(lambda: stack.status()["first"].state is State.SILENT, SOON_S)


def test_stop_ends_even_what_ignores_sigterm_or_is_frozen(launch):
    stack = launch(
        stubborn={"command": [sys.executable, "-uc", STUBBORN], "stop_grace_period": "500ms"}, frozen=SLEEP
    )
    assert wait_until(lambda: (stack.logs / "stubborn.jsonl").read_text() == "up\n", SOON_S)
    stack.kill("frozen", signal.SIGSTOP)
    pids = [stack.pid(name) for name in ("stubborn", "frozen")]
    stack.stop()
    assert all(gone(pid) for pid in pids)


def test_children_of_a_killed_service_do_not_outlive_it(launch):
    stack = launch(parent=[sys.executable, "-c", PARENT])
    log = stack.logs / "parent.jsonl"
    assert wait_until(lambda: log.exists() and log.read_text().strip() != "", SOON_S)
    child = int(log.read_text().split()[0])
    os.kill(stack.pid("parent"), signal.SIGKILL)
    assert wait_until(lambda: gone(child), SOON_S)


def test_two_stacks_in_one_folder_are_refused(launch, tmp_path):
    launch(a=SLEEP)
    other = Launcher(tmp_path / "data", compose_file=tmp_path / "docker-compose.yml")
    with pytest.raises(AlreadyRunningError, match="topnav down"):
        other.start()


def test_a_service_gets_the_environment_of_the_file_and_then_the_callers(tmp_path):
    show = [
        sys.executable,
        "-c",
        "import os, time; print(os.environ['A'], os.environ['B'], flush=True); time.sleep(600)",
    ]
    path = compose(tmp_path, a={"command": show, "environment": {"A": "${TOPNAV_SEED}", "B": "file"}})
    with Launcher(tmp_path / "data", seed=7, environment={"B": "caller"}, compose_file=path) as stack:
        log = stack.logs / "a.jsonl"
        assert wait_until(lambda: log.read_text() == "7 caller\n", SOON_S)


def run_topnav(*arguments):
    command = [sys.executable, "-m", "services.launcher", *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=2 * SOON_S, check=False)


def test_up_detached_status_and_down_from_the_shell(tmp_path):
    path, data = compose(tmp_path, a=SLEEP, b=SLEEP), ["--data-dir", str(tmp_path / "data")]
    up = run_topnav("up", "--detach", "--file", str(path), *data)
    assert up.returncode == 0, up.stderr
    status = run_topnav("status", "--json", *data)
    services = json.loads(status.stdout)["services"]
    assert status.returncode == 0
    assert {name: service["state"] for name, service in services.items()} == {"a": "healthy", "b": "healthy"}
    again = run_topnav("up", "--detach", "--file", str(path), *data)
    assert again.returncode == 1
    assert "already running" in again.stderr
    assert run_topnav("down", *data).stdout == "stopped\n"
    assert all(gone(service["pid"]) for service in services.values())
    assert run_topnav("status", *data).returncode == 1


def test_no_service_outlives_a_launcher_that_was_killed(tmp_path):
    path, data = compose(tmp_path, a=SLEEP, b=SLEEP), ["--data-dir", str(tmp_path / "data")]
    assert run_topnav("up", "--detach", "--file", str(path), *data).returncode == 0
    state = StateFolder(tmp_path / "data").read()
    os.kill(state.launcher_pid, signal.SIGKILL)
    pids = [service.pid for service in state.services.values()]
    assert wait_until(lambda: all(gone(pid) for pid in pids), SOON_S)
    assert wait_until(lambda: StateFolder(tmp_path / "data").read() is None, SOON_S)
    assert "no stack runs" in run_topnav("down", *data).stdout


def test_a_failing_up_is_one_line_and_exit_1(tmp_path):
    bad = [sys.executable, "-c", "raise SystemExit('broken')"]
    path = compose(tmp_path, bad={"command": bad, "healthcheck": NEVER})
    up = run_topnav("up", "--file", str(path), "--data-dir", str(tmp_path / "data"), "--timeout-s", "1")
    assert up.returncode == 1
    assert up.stderr.startswith("topnav: ")
    assert "bad.jsonl" in up.stderr
    assert len(up.stderr.splitlines()) == 1


def stands(folder):
    """Whether the folder could be made; not while the launcher writes a file of that name."""
    try:
        folder.mkdir()
    except FileExistsError:
        return False
    return True


def test_a_state_that_cannot_be_written_ends_nothing_and_is_written_once_it_can_be(launch, tmp_path):
    """As on a full disk: the file cannot be replaced while something stands where its new version goes."""
    stack = launch(a=SLEEP, b=SLEEP)
    way = tmp_path / "data" / "launcher" / "state.new"
    assert wait_until(lambda: stands(way), SOON_S)
    other = stack.pid("b")
    old = stack.kill("a")
    stack.wait_healthy("a", SOON_S, other_than=old)
    assert (stack.running, stack.pid("b")) == (True, other)
    assert StateFolder(tmp_path / "data").read().services["a"].state is State.EXITED, "not as it was written"
    way.rmdir()
    assert wait_until(
        lambda: StateFolder(tmp_path / "data").read().services["a"].pid == stack.pid("a"), SOON_S
    )


def test_a_service_that_cannot_be_started_for_a_while_is_tried_again(launch, monkeypatch):
    """As without room for its log, or without a process or file descriptor left."""
    stack = launch(a=SLEEP, b=SLEEP)
    spawn, refused = subprocess.Popen, []

    def none_left(*arguments, **options):
        if len(refused) < 3:
            refused.append(1)
            raise OSError(24, "Too many open files")
        return spawn(*arguments, **options)

    other = stack.pid("b")
    monkeypatch.setattr(subprocess, "Popen", none_left)
    old = stack.kill("a")
    stack.wait_healthy("a", SOON_S, other_than=old)
    assert (len(refused), stack.running, stack.pid("b")) == (3, True, other)


def test_the_log_of_a_running_service_does_not_grow_without_bound(launch, monkeypatch):
    monkeypatch.setattr(process, "LOG_BYTES", 100_000)
    monkeypatch.setattr(process.rotate, "__defaults__", (100_000,))
    talk = "import time\nwhile True: print('x' * 999, flush=True); time.sleep(0.001)"
    stack = launch(a=[sys.executable, "-c", talk])
    log, pid = stack.logs / "a.jsonl", stack.pid("a")
    old = stack.logs / "a.jsonl.1"
    assert wait_until(old.exists, SOON_S)
    sizes = []
    assert wait_until(lambda: sizes.append(log.stat().st_size) or len(sizes) > 40, SOON_S, 0.1)
    assert max(sizes) < 4_000_000, "a second's worth beyond the limit"
    assert min(sizes[1:]) < 100_000, "emptied while the service runs"
    assert stack.pid("a") == pid


def test_what_env_says_of_a_services_own_settings_reaches_its_process(tmp_path):
    tell = [
        sys.executable,
        "-c",
        "import os, time; print(os.environ['DRIVE_SEED'], flush=True); time.sleep(600)",
    ]
    file = compose(tmp_path, drive=tell)
    (tmp_path / ".env").write_text("DRIVE_SEED=77\n", encoding="utf-8")
    variables = variables_with_dotenv(tmp_path)
    with Launcher(tmp_path / "data", compose_file=file, variables=variables, timeout_s=SOON_S) as launcher:
        assert wait_until(lambda: "77" in (launcher.logs / "drive.jsonl").read_text(encoding="utf-8"), SOON_S)
