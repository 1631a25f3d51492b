"""The router of the real Compose file, under the launcher."""

import subprocess
import sys
import threading

import pytest

from services.launcher.processes.supervisor import Launcher
from shared.bus import open_bus, wait_until

SOON_S, RUN_S = 60.0, 120.0

pytestmark = pytest.mark.usefixtures("patient_sessions")


@pytest.fixture
def stack(tmp_path):
    with Launcher(tmp_path, only=["router"]) as launcher:
        yield launcher


def test_two_peers_find_each_other_through_it_also_after_it_was_killed(stack):
    with open_bus(stack.endpoint) as one, open_bus(stack.endpoint) as two:
        one.announce("drive")
        assert wait_until(lambda: two.alive("drive") == ["drive"], SOON_S)
        old = stack.kill("router")
        stack.wait_healthy("router", SOON_S, other_than=old)
        with open_bus(stack.endpoint) as late:
            assert wait_until(lambda: late.alive("drive") == ["drive"], SOON_S)


def test_the_health_command_of_the_compose_file_agrees(stack):
    command = [sys.executable, "-m", "shared.health", "router"]
    environment = {"TOPNAV_ENDPOINT": stack.endpoint, "PATH": ""}

    def agrees():
        return subprocess.run(command, env=environment, timeout=RUN_S, check=False).returncode == 0

    assert wait_until(agrees, SOON_S), "it waits a while, and is asked again and again there as here"
    absent = subprocess.run(
        [*command[:-1], "planner"], env=environment, timeout=RUN_S, check=False, capture_output=True
    )
    assert absent.returncode == 1
    assert b"planner: not alive" in absent.stderr


def test_a_router_whose_port_is_taken_says_so_and_ends(stack):
    port_taken = {"TOPNAV_ROUTER_LISTEN": stack.endpoint, "PATH": ""}
    command = [sys.executable, "-m", "shared.router"]
    second = subprocess.run(command, env=port_taken, timeout=RUN_S, check=False, capture_output=True)
    assert second.returncode == 1
    assert b"is another router running?" in second.stderr


def test_the_launcher_leaves_no_thread_behind(tmp_path):
    before = set(threading.enumerate())
    with Launcher(tmp_path, only=["router"]):
        pass
    assert set(threading.enumerate()) <= before
