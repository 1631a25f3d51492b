"""A stack left behind in a process of its own: what a person reads when it does not come up."""

import sys

import pytest

from services.launcher.processes.running import start_detached
from services.launcher.processes.stack_settings import StackSettings
from services.launcher.processes.state import StateFolder
from services.launcher.processes.wait import LaunchError
from tests.integration.launcher.test_supervisor import NEVER, SLEEP, compose

START_S = 3.0
"""Less than five exits and the pauses between them take: nothing counts as a crash storm yet."""


def test_a_detached_start_that_runs_out_of_time_names_the_service_that_fails_and_its_reason(tmp_path):
    taken = [sys.executable, "-c", "raise SystemExit('no HTTP on 127.0.0.1:8001: is the port taken?')"]
    needs = {"depends_on": {"store": {"condition": "service_healthy"}}}
    services = {"gateway": {"command": SLEEP, **needs}, "store": {"command": taken, "healthcheck": NEVER}}
    settings = StackSettings(tmp_path / "data")
    reason = r"not healthy after 3 s: .*is the port taken\? \(see .*store.jsonl"
    with pytest.raises(LaunchError, match=reason):
        start_detached(settings, compose(tmp_path, **services), START_S)
    assert not StateFolder(settings.data_dir).owned()


@pytest.mark.parametrize("variable", ["TOPNAV_ROBOT", "TOPNAV_ROBOTS", "TOPNAV_FEATURES_ROBOTS"])
def test_what_is_no_robot_s_name_is_told_before_anything_starts(tmp_path, monkeypatch, variable):
    monkeypatch.setenv(variable, "*")
    settings = StackSettings(tmp_path / "data")
    with pytest.raises(LaunchError, match=rf"did not come up: {variable}: a robot's name must .*got '\*'"):
        start_detached(settings, compose(tmp_path, drive=SLEEP), START_S)
    assert {path.name for path in StateFolder(settings.data_dir).logs.iterdir()} == {"launcher.log"}
