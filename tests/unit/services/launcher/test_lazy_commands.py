"""Commands that live in other modules."""

import sys
import types

import pytest
import typer
from typer.testing import CliRunner

from services.launcher.lazy_commands import COMMANDS, CommandMissingError, LazyCommand, load, register


def make_app(commands):
    app = typer.Typer()
    register(app, commands)

    @app.command()
    def other() -> None:
        """Make this a group of commands."""

    return app


@pytest.fixture
def plugin(monkeypatch):
    """A module with a Typer app of one command that records what it got."""
    module, app, calls = types.ModuleType("plugin_for_test"), typer.Typer(), []

    @app.command()
    def run(name: str, seed: int = 1) -> None:
        calls.append((name, seed))

    module.app = app
    monkeypatch.setitem(sys.modules, "plugin_for_test", module)
    return calls


def test_arguments_and_options_reach_the_other_module(plugin):
    app = make_app({"hide": LazyCommand("plugin_for_test", "Hide.")})
    result = CliRunner().invoke(app, ["hide", "flat", "--seed", "4"])
    assert result.exit_code == 0, result.output
    assert plugin == [("flat", 4)]


def test_help_of_a_command_is_its_own_and_the_list_needs_no_import(plugin):
    app = make_app(
        {"hide": LazyCommand("plugin_for_test", "Hide."), "gone": LazyCommand("no_such_module", "Gone.")}
    )
    assert "--seed" in CliRunner().invoke(app, ["hide", "--help"]).output
    assert "Gone." in CliRunner().invoke(app, ["--help"]).output
    assert plugin == []


def test_a_wrong_option_exits_with_2(plugin):
    result = CliRunner().invoke(
        make_app({"hide": LazyCommand("plugin_for_test", "Hide.")}), ["hide", "--sed", "4"]
    )
    assert result.exit_code == 2
    assert plugin == []


def test_a_missing_module_and_a_missing_app_are_named():
    with pytest.raises(CommandMissingError, match="topnav x needs the Python module 'no_such_module'"):
        load("x", LazyCommand("no_such_module", ""))
    with pytest.raises(CommandMissingError, match="json must define a Typer named `app`"):
        load("x", LazyCommand("json", ""))


def test_the_documented_commands_are_there():
    assert {"demo", "explore", "goto", "hide-and-seek", "study", "bench", "map"} <= set(COMMANDS)
