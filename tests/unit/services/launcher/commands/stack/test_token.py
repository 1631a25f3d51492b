"""`topnav token`."""

import pytest
from typer.testing import CliRunner

from services.launcher.commands.stack.token import app
from shared.access.tokens import find, read_tokens


@pytest.fixture
def run(tmp_path):
    """Call a subcommand; the file is its last argument."""
    path = tmp_path / "made" / "tokens.json"

    def call(*arguments):
        return CliRunner().invoke(app, [*arguments, str(path)])

    call.path = path
    return call


def test_the_secret_is_printed_once_and_opens_its_role(run):
    made = run("add", "anna", "--role", "operator")
    secret = made.stdout.strip()
    found = find(read_tokens(run.path), secret)
    assert (found.name, found.role) == ("anna", "operator")
    assert secret not in run.path.read_text()
    assert secret not in run("list").stdout


def test_the_least_role_is_the_default_and_tokens_are_listed(run):
    run("add", "bert")
    run("add", "anna", "--role", "admin")
    assert [line.split() for line in run("list").stdout.splitlines()] == [
        ["bert", "viewer"],
        ["anna", "admin"],
    ]


def test_a_removed_token_is_gone_and_the_others_stay(run):
    run("add", "anna")
    secret = run("add", "bert").stdout.strip()
    assert run("remove", "anna").exit_code == 0
    assert [token.name for token in read_tokens(run.path)] == ["bert"]
    assert find(read_tokens(run.path), secret) is not None


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("add", "anna"), "already"),
        (("add", "Anna"), "a name is"),
        (("add", "an na"), "a name is"),
        (("add", "x" * 33), "a name is"),
        (("add", "planner"), "a program"),
        (("add", "bert", "--role", "root"), "viewer, agent, operator, admin"),
        (("remove", "bert"), "there are: anna"),
    ],
)
def test_what_cannot_be_is_said_and_changes_nothing(run, arguments, words):
    run("add", "anna")
    before = run.path.read_bytes()
    answer = run(*arguments)
    assert answer.exit_code != 0
    assert words in str(answer.exception)
    assert run.path.read_bytes() == before


def test_a_file_that_is_not_there_is_only_made_by_add(run):
    assert "topnav token add" in str(run("list").exception)
    assert "topnav token add" in str(run("remove", "anna").exception)
    assert not run.path.exists()
