"""`topnav drive` at the shell: it moves the robot for a while, and says when nobody obeys."""

import threading

import pytest
from typer.testing import CliRunner

from services.launcher.commands.robots.drive import app
from shared.bus import wait_until
from tests.integration.drive.conftest import SOON_S


@pytest.fixture
def topnav_drive(router_endpoint, monkeypatch):
    monkeypatch.setattr("services.launcher.client.hand.MEETING_S", SOON_S)

    def run(*words):
        return CliRunner().invoke(app, [*words, "--who", "anna", "--endpoint", router_endpoint])

    return run


@pytest.fixture
def robot(neighbours):
    """A robot that senses all the time; returns what it was told meanwhile."""
    told, over = [], threading.Event()

    def senses():
        while not over.is_set():
            told.extend(neighbours.commands(0.1, lambda: neighbours.see(neighbours.frame())))

    thread = threading.Thread(target=senses)
    thread.start()
    yield told
    over.set()
    thread.join()


def test_the_robot_moves_for_as_long_as_was_said_and_stands_then(start, topnav_drive, robot):
    start()
    done = topnav_drive("--forward", "0.2", "--turn", "0.3", "--seconds", "2")
    assert done.exit_code == 0, done.output
    assert "at most 0.20 m/s" in done.output
    assert (0.2, 0.3) in {(velocity.forward_mps, velocity.turn_radps) for velocity in robot}
    assert wait_until(lambda: robot[-1].stands, SOON_S)


def test_a_robot_that_its_emergency_stop_holds_does_not_obey(start, topnav_drive, neighbours, robot):
    start()
    neighbours.estop("engage", who="eve", why="a child")
    done = topnav_drive("--forward", "0.2", "--seconds", "0.5")
    assert "did not obey" in str(done.exception)
    assert all(velocity.stands for velocity in robot)


def test_without_a_drive_service_it_says_so(topnav_drive, monkeypatch):
    monkeypatch.setattr("services.launcher.client.hand.MEETING_S", 0.5)
    assert "no drive service" in str(topnav_drive("--forward", "0.2").exception)
