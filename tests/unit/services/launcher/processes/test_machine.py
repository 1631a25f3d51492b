"""Checks of the machine."""

import socket
import subprocess

import pytest

from services.launcher.processes import machine
from services.launcher.processes.stack_settings import Ports


@pytest.fixture
def answer(monkeypatch):
    """Set what the next Python process of a check answers."""

    def give(code, out="", err=""):
        result = subprocess.CompletedProcess([], code, out, err)
        monkeypatch.setattr(machine, "_python", lambda *_: result)

    return give


def test_a_taken_port_is_named_with_the_variable_that_moves_it():
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        free = Ports.free()
        port = taken.getsockname()[1]
        check = machine.check_ports(Ports(free.router, port, free.map_store), stack_runs=False)
        assert not check.ok
        assert check.fix == f"set TOPNAV_GATEWAY_PORT to another port than {port}"
        assert machine.check_ports(Ports(free.router, port, free.map_store), stack_runs=True).ok
    assert machine.check_ports(free, stack_runs=False).ok


def test_a_machine_that_cannot_render_is_told_how_to(answer):
    answer(1, err="Traceback\nRuntimeError: failed to find a rendering device\n")
    check = machine.check_rendering()
    assert not check.ok
    assert check.detail == "RuntimeError: failed to find a rendering device"
    assert "deploy/setup/vulkan.sh" in check.fix
    answer(0, out="(32, 32, 4)")
    assert machine.check_rendering().ok


def test_a_driver_that_crashes_without_a_word_still_gets_a_detail(answer):
    answer(-11)
    assert machine.check_rendering().detail == "exit -11"


def test_a_cv2_without_beblid_fails(answer):
    answer(1, err="AttributeError: module 'cv2.xfeatures2d' has no attribute 'BEBLID_create'")
    check = machine.check_opencv()
    assert not check.ok
    assert "BEBLID_create" in check.detail


def test_too_little_disk_fails_and_a_folder_not_made_yet_is_fine(tmp_path, monkeypatch):
    assert machine.check_disk(tmp_path / "not" / "yet").ok
    monkeypatch.setattr(machine, "DISK_NEEDED_GB", 1e9)
    assert not machine.check_disk(tmp_path).ok


def test_weights_are_listed_and_never_required(tmp_path, monkeypatch):
    monkeypatch.setenv("TORCH_HOME", str(tmp_path))
    assert machine.check_weights().ok
    (tmp_path / "hub" / "checkpoints").mkdir(parents=True)
    (tmp_path / "hub" / "checkpoints" / "aliked-t16.pth").touch()
    assert "aliked-t16.pth" in machine.check_weights().detail


def test_exactly_one_distribution_owns_cv2_and_it_has_beblid():
    check = machine.check_opencv()
    assert check.ok, check
