"""`topnav estop` at the shell, against a drive process and against nobody."""

import pytest
from typer.testing import CliRunner

from services.launcher.commands.robots.estop import app
from tests.integration.drive.conftest import SOON_S


@pytest.fixture
def topnav_estop(router_endpoint):
    def run(*words):
        return CliRunner().invoke(app, [*words, "--endpoint", router_endpoint])

    return run


@pytest.fixture
def patience(monkeypatch):
    """Each call is a session of its own, which on a slow machine may meet drive later than people wait."""
    monkeypatch.setattr("services.launcher.commands.robots.estop.TIMEOUT_S", SOON_S)
    monkeypatch.setattr("shared.queries.MEETING_S", SOON_S)


@pytest.mark.usefixtures("patience")
def test_engage_status_and_clear(start, topnav_estop):
    start()
    assert topnav_estop("--status").exit_code == 0
    engaged = topnav_estop("--why", "a child")
    assert engaged.exit_code == 0
    assert "r1: engaged since" in engaged.output
    status = topnav_estop("--status")
    assert status.exit_code == 1
    assert "a child" in status.output
    nobody = topnav_estop("--clear")
    assert nobody.exit_code == 2
    assert "--who NAME" in nobody.output
    cleared = topnav_estop("--clear", "--who", "anna")
    assert cleared.exit_code == 0
    assert "by anna" in cleared.output
    assert topnav_estop("--status").exit_code == 0


@pytest.mark.parametrize("robot", ["*", "r1/**", "missions"])
def test_what_is_no_robot_is_refused(topnav_estop, robot):
    answer = topnav_estop("--robot", robot)
    assert answer.exit_code == 2
    assert "--robot: a robot's name must match" in answer.output


def test_a_stop_asks_for_no_setting_that_it_does_not_need(router_endpoint, tmp_path, monkeypatch):
    monkeypatch.setenv("TOPNAV_ENDPOINT", router_endpoint)
    monkeypatch.setenv("TOPNAV_ROBOT", "*")
    answer = CliRunner().invoke(app, ["--data-dir", str(tmp_path)])
    assert "no drive service answers" in answer.output


@pytest.mark.parametrize("words", [[], ["--status"], ["--clear", "--who", "anna"]])
def test_without_a_drive_service_it_says_what_stops_the_robot(topnav_estop, words):
    answer = topnav_estop(*words)
    assert answer.exit_code == 2
    assert "no drive service answers: the robot's own time-out stops it" in answer.output
