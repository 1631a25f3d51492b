"""`topnav task` and `topnav schedule` on a stack that runs."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner

from services.launcher.cli import app
from services.launcher.client.failure import ExperimentError
from tests.integration.dispatch.conftest import Queue


@pytest.fixture
def topnav(endpoint: str, queue: Queue, tmp_path: Path):
    """Runs a command; what it printed, or the error that `topnav` shows as one line."""
    assert queue

    def run(*arguments: str) -> str:
        options = ["--endpoint", endpoint, "--data-dir", str(tmp_path)]
        result = CliRunner().invoke(app, [*arguments, *options])
        if result.exception is not None:
            raise result.exception
        return result.output

    return run


def test_tasks_are_added_listed_moved_and_cancelled(topnav, queue: Queue):
    topnav("task", "add", "count", "--id", "slow", "--set", "frames=10000")
    queue.wait("slow", "running")
    assert topnav("task", "add", "count", "--id", "later", "--priority", "2").startswith(
        "later: count in flat"
    )
    assert topnav("task", "add", "count", "--id", "sooner") == "sooner: count in flat, 1 before it\n"
    assert topnav("task", "priority", "later", "9") == "later: priority 9\n"
    listed = json.loads(topnav("task", "list", "--json", "--ended", "0"))
    assert [task["task_id"] for task in listed] == ["slow", "later", "sooner"]
    assert listed[0]["parameters"] == {"frames": 10_000}
    assert topnav("task", "cancel", "later") == "later: cancelled\n"
    assert topnav("task", "cancel", "slow") == "slow: cancelled while it ran\n"
    queue.wait("slow", "cancelled")
    assert "sooner" in topnav("task", "list")


def test_tasks_for_whichever_robot_are_added_listed_and_cancelled(topnav, queue: Queue):
    assert queue
    assert topnav("task", "add", "count", "--robot", "any", "--id", "ours").startswith("ours: count in flat")
    (listed,) = json.loads(topnav("task", "list", "--robot", "any", "--json", "--ended", "0"))
    assert (listed["task_id"], listed["robot"], listed["fleet"]) == ("ours", "any", True)
    assert "any" in topnav("task", "list", "--robot", "any")
    assert topnav("task", "cancel", "ours", "--robot", "any") == "ours: cancelled\n"
    with pytest.raises(ExperimentError, match="the fleet has no task 'none'"):
        topnav("task", "cancel", "none", "--robot", "any")


def test_schedules_are_set_listed_and_removed(topnav):
    said = topnav("schedule", "set", "night", "0 22 * * *", "count", "--zone", "Europe/Zurich")
    assert said.startswith("night: count in flat, next ")
    assert "Europe/Zurich" in topnav("schedule", "list")
    assert "next off" in topnav("schedule", "set", "night", "0 22 * * *", "count", "--off")
    assert topnav("schedule", "remove", "night") == "night: removed\n"
    assert json.loads(topnav("schedule", "list", "--json")) == []


@pytest.mark.parametrize(
    ("command", "says"),
    [
        (("task", "add", "fly"), "unknown kind 'fly': one of "),
        (("task", "add", "count", "--id", "No"), "task_id: String should match pattern"),
        (("task", "cancel", "none"), "r1 has no task 'none'"),
        (("schedule", "set", "night", "0 25 * * *", "count"), "field hour cannot be '25'"),
        (("schedule", "set", "night", "0 22 * * *", "count", "--zone", "Mars"), "unknown time zone 'Mars'"),
        (("schedule", "remove", "none"), "r1 has no schedule 'none'"),
    ],
)
def test_what_is_wrong_is_said_in_one_line(topnav, command, says):
    with pytest.raises(ExperimentError) as caught:
        topnav(*command)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)


def test_without_a_stack_the_command_says_so(tmp_path: Path):
    result = CliRunner().invoke(app, ["task", "list", "--data-dir", str(tmp_path)])
    assert str(result.exception).startswith(f"no stack runs in {tmp_path}: start one with 'topnav up'")
