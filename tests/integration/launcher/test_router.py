"""The router of the real Compose file, under the launcher."""

import subprocess
import sys
import threading

import pytest

from services.launcher.supervisor import Launcher
from shared.bus import open_bus, wait_until


@pytest.fixture
def stack(tmp_path):
    with Launcher(tmp_path, only=["router"], timeout_s=30.0) as launcher:
        yield launcher


def test_two_peers_find_each_other_through_it_also_after_it_was_killed(stack):
    with open_bus(stack.endpoint) as one, open_bus(stack.endpoint) as two:
        one.announce("drive")
        assert wait_until(lambda: two.alive("drive") == ["drive"], 10.0)
        old = stack.kill("router")
        stack.wait_healthy("router", timeout_s=5.0, other_than=old)
        with open_bus(stack.endpoint) as late:
            assert wait_until(lambda: late.alive("drive") == ["drive"], 10.0)


def test_the_health_command_of_the_compose_file_agrees(stack):
    command = [sys.executable, "-m", "shared.health", "router"]
    environment = {"TOPNAV_ENDPOINT": stack.endpoint, "PATH": ""}
    assert subprocess.run(command, env=environment, timeout=30, check=False).returncode == 0
    absent = subprocess.run(
        [*command[:-1], "planner"], env=environment, timeout=30, check=False, capture_output=True
    )
    assert absent.returncode == 1
    assert b"planner: not alive" in absent.stderr


def test_a_router_whose_port_is_taken_says_so_and_ends(stack):
    port_taken = {"TOPNAV_ROUTER_LISTEN": stack.endpoint, "PATH": ""}
    command = [sys.executable, "-m", "shared.router"]
    second = subprocess.run(command, env=port_taken, timeout=30, check=False, capture_output=True)
    assert second.returncode == 1
    assert b"is another router running?" in second.stderr


def test_the_launcher_leaves_no_thread_behind(tmp_path):
    before = set(threading.enumerate())
    with Launcher(tmp_path, only=["router"]):
        pass
    assert set(threading.enumerate()) <= before
