"""The studies join `topnav` by the entry points of their own distribution."""

import subprocess
import sys
import tomllib
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
import typer
from typer.testing import CliRunner

from services.launcher import cli
from tests.unit.services.launcher.test_cli import HEAVY

PROJECT = Path(__file__).resolve().parents[4] / "experiments" / "pyproject.toml"
DECLARED = tomllib.loads(PROJECT.read_text(encoding="utf-8"))["project"]["entry-points"][cli.ADDED]
STUDIES = {"heading", "heading-frames", "disturbance", "disturbance-matches", "failures", "matching"}
STUDIES |= {"keypoints", "photographs", "recovery", "scale"}


@pytest.fixture(scope="module")
def topnav():
    """A `topnav` with the commands of the studies alone."""
    app = typer.Typer()
    cli.add_commands(app, [EntryPoint(name, value, cli.ADDED) for name, value in DECLARED.items()])
    return app


def test_what_the_product_sends_people_to_is_what_the_studies_bring():
    assert DECLARED.keys() == set(cli.STUDIES)


@pytest.mark.parametrize("name", DECLARED)
def test_every_command_is_there_under_its_name(topnav, name):
    shown = CliRunner().invoke(topnav, [name, "--help"])
    assert shown.exit_code == 0
    assert "--help" in shown.output


def test_every_study_is_there(topnav):
    shown = CliRunner().invoke(topnav, ["study", "--help"]).output
    assert all(f" {name} " in shown for name in STUDIES)


def test_they_load_nothing_heavy_before_they_are_called():
    modules = ", ".join(value.partition(":")[0] for value in DECLARED.values())
    code = f"import sys, {modules}; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert not {name.partition(".")[0] for name in loaded.split()} & HEAVY
