"""`topnav goto`: one goal, said in one of five ways; what else is given is refused before anything starts."""

import itertools
import re

import pytest
from typer.testing import CliRunner

from services.launcher import cli

GOALS = {
    "--image": ("--image", "flat.png"),
    "--photo": ("--photo", "phone.jpg"),
    "--place": ("--place", "dock"),
    "--sign": ("--sign", "214"),
    "--home": ("--home",),
}


@pytest.fixture(autouse=True)
def _nothing_starts(monkeypatch):
    def open_stack(_choice):
        raise AssertionError("a stack was started")

    monkeypatch.setattr("services.launcher.client.stack.open_stack", open_stack)


def refusal(*arguments):
    """What is printed, without the frame that the terminal draws around it."""
    result = CliRunner().invoke(cli.app, ["goto", *arguments], env={"COLUMNS": "300"})
    assert result.exit_code == 2, result.output
    return re.sub(r"\s+", " ", result.output)


def test_without_a_goal_the_ways_to_say_one_are_named():
    told = refusal()
    assert "one of --image, --photo, --place, --sign, --home says where to go, given: none" in told


@pytest.mark.parametrize(("first", "second"), list(itertools.permutations(GOALS, 2)))
def test_of_two_goals_none_is_preferred_and_both_are_named(first, second):
    told = refusal(*GOALS[first], *GOALS[second])
    assert f"given: {', '.join(goal for goal in GOALS if goal in (first, second))}" in told


@pytest.mark.parametrize("goal", ["--image", "--place", "--home"])
def test_a_field_of_view_belongs_to_a_photo(goal):
    told = refusal(*GOALS[goal], "--field-of-view-deg", "60")
    assert f"--field-of-view-deg is of an ordinary photo, given {goal}: give it with --photo" in told


@pytest.mark.parametrize(
    ("degrees", "expected"), [("19", "equal to 20"), ("131", "equal to 130"), ("wide", "a number")]
)
def test_a_field_of_view_that_no_phone_has_is_refused(degrees, expected):
    told = refusal("--photo", "phone.jpg", "--field-of-view-deg", degrees)
    assert "'--field-of-view-deg'" in told
    assert expected in told


def test_a_photo_that_cannot_be_read_is_refused_before_a_stack_starts(tmp_path):
    photo = tmp_path / "phone.jpg"
    photo.write_bytes(b"\xff\xd8\xff no picture")
    result = CliRunner().invoke(cli.app, ["goto", "--photo", str(photo)])
    assert f"{photo} is not a picture that can be read" in str(result.exception)
