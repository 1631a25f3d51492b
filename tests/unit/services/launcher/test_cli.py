"""The commands of `topnav`: its own, those of other distributions, and those that are not to be had."""

import os
import subprocess
import sys
from importlib.metadata import EntryPoint

import pytest
import typer
from typer.testing import CliRunner

from services.launcher import cli

DOCUMENTED = {
    "demo",
    "explore",
    "goto",
    "locate",
    "up",
    "down",
    "status",
    "doctor",
    "estop",
    "world",
    "models",
    "map",
}
DOCUMENTED |= {"record", "replay", "recover", "foxglove", "mcp", "certs", "token"}
HEAVY = {"zenoh", "torch", "cv2", "sapien", "matplotlib", "numpy", "httpx", "pydantic", "cryptography"}

extra = typer.Typer()


@extra.command("hide")
def hide(name: str, seed: int = 1) -> None:
    """Hide somewhere."""
    typer.echo(f"{name} {seed}")


def with_commands(*found):
    """A `topnav` with the commands of these entry points, given as (name, module:attribute)."""
    app = typer.Typer()
    app.command("other")(lambda: None)
    cli.add_commands(app, [EntryPoint(name, value, cli.ADDED) for name, value in found])
    return app


HERE = (("hide", "tests.unit.services.launcher.test_cli:extra"), ("gone", "no_such_module:app"))


def test_the_documented_commands_are_there():
    shown = CliRunner().invoke(cli.app, ["--help"]).output
    assert all(f" {name} " in shown for name in DOCUMENTED)


def test_arguments_and_options_reach_a_command_of_another_distribution():
    result = CliRunner().invoke(with_commands(*HERE), ["hide", "flat", "--seed", "4"])
    assert (result.exit_code, result.output) == (0, "flat 4\n")
    assert "--seed" in CliRunner().invoke(with_commands(*HERE), ["hide", "--help"]).output
    assert CliRunner().invoke(with_commands(*HERE), ["hide", "flat", "--sed", "4"]).exit_code == 2


def test_what_cannot_be_loaded_says_so_when_called_and_not_in_the_help():
    shown = CliRunner().invoke(with_commands(*HERE), ["--help"])
    assert shown.exit_code == 0
    assert "no_such_module" not in shown.output
    result = CliRunner().invoke(with_commands(*HERE), ["gone", "--any", "option"])
    assert isinstance(result.exception, cli.MissingCommandError)
    assert "topnav gone cannot be loaded from no_such_module:app" in str(result.exception)


def test_an_entry_point_that_is_no_command_is_named():
    broken = with_commands(("json", "json:dumps"))
    assert "cannot be loaded" in str(CliRunner().invoke(broken, ["json"]).exception)


@pytest.mark.parametrize("name", cli.STUDIES)
def test_without_the_studies_their_commands_say_how_to_get_them(name):
    alone = with_commands()
    assert name not in CliRunner().invoke(alone, ["--help"]).output
    result = CliRunner().invoke(alone, [name, "--help"])
    assert "pip install ./experiments" in str(result.exception)


def test_a_missing_command_is_one_line_and_a_failure(monkeypatch, capsys):
    monkeypatch.setattr(cli, "app", with_commands())
    monkeypatch.setattr(sys, "argv", ["topnav", "study", "scale"])
    with pytest.raises(SystemExit) as caught:
        cli.main()
    assert caught.value.code == 1
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("topnav: topnav study belongs to topnav-studies")


def test_the_list_of_commands_loads_nothing_heavy():
    code = "import sys; from services.launcher import cli; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert not {name.partition(".")[0] for name in loaded.split()} & HEAVY


LEARNED = """
import services.launcher.cli as command
command.app = lambda: __import__("torch")
command.main()
"""


def test_threads_of_a_command_that_loads_torch_do_not_spin(repository):
    plain = {name: value for name, value in os.environ.items() if not name.startswith("OMP_")}
    told = {**plain, "OMP_DISPLAY_ENV": "VERBOSE"}  # the library says what it has read
    run = subprocess.run(
        [sys.executable, "-c", LEARNED], cwd=repository, env=told, capture_output=True, check=True, text=True
    )
    assert "GOMP_SPINCOUNT = '0'" in run.stderr
