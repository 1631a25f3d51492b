"""Settings: from the environment, frozen, and a misspelt name is an error that lists the right ones."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from pydantic import BaseModel, Field
from pydantic_settings import SettingsConfigDict

from shared.settings import ServiceSettings


class Limits(BaseModel):
    """Nested options."""

    speed: float = Field(default=1.0, gt=0.0)


class ArmSettings(ServiceSettings):
    """Settings of a service that does not exist."""

    model_config = SettingsConfigDict(env_prefix="ARM_")

    rate_hz: float = Field(default=20.0, gt=0.0)
    limits: Limits = Limits()


@pytest.fixture(autouse=True)
def _bare_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("TOPNAV_ENDPOINT", "TOPNAV_ROBOT", "TOPNAV_LOG_LEVEL"):
        monkeypatch.delenv(name, raising=False)


def test_defaults_hold_without_an_environment():
    settings = ArmSettings.from_environment()
    assert (settings.robot, settings.rate_hz, settings.limits.speed) == ("r1", 20.0, 1.0)


def test_own_and_nested_names_are_read(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("ARM_RATE_HZ", "5")
    monkeypatch.setenv("ARM_LIMITS__SPEED", "2.5")
    settings = ArmSettings.from_environment()
    assert (settings.rate_hz, settings.limits.speed) == (5.0, 2.5)


def test_common_names_are_read_and_the_service_s_own_win(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("TOPNAV_ROBOT", "r2")
    monkeypatch.setenv("TOPNAV_ENDPOINT", "tcp/10.0.0.1:7447")
    monkeypatch.setenv("ARM_ENDPOINT", "tcp/10.0.0.2:7447")
    settings = ArmSettings.from_environment()
    assert (settings.robot, settings.endpoint) == ("r2", "tcp/10.0.0.2:7447")


@pytest.mark.parametrize("name", ["ARM_RATE_HX", "ARM_LIMIT__SPEED", "ARM_LIMITS__SPED", "ARM_"])
def test_a_misspelt_name_is_refused_with_the_choices(monkeypatch: pytest.MonkeyPatch, name: str):
    monkeypatch.setenv(name, "5")
    with pytest.raises(ValueError, match=rf"{name}: no such setting; .*'rate_hz'"):
        ArmSettings.from_environment()


@pytest.mark.parametrize(("name", "value"), [("ARM_RATE_HZ", "0"), ("ARM_RATE_HZ", "fast")])
def test_bad_values_are_refused(monkeypatch: pytest.MonkeyPatch, name: str, value: str):
    monkeypatch.setenv(name, value)
    with pytest.raises(ValueError, match="ARM_RATE_HZ: Input should be"):
        ArmSettings.from_environment()


BAD_NAMES = ["", "*", "r1/**", "r 1", "\u00e9", "R1", "missions"]


@pytest.mark.parametrize("name", BAD_NAMES)
def test_what_is_no_robot_s_name_is_refused_with_the_variable(monkeypatch: pytest.MonkeyPatch, name: str):
    for variable in ("TOPNAV_ROBOT", "ARM_ROBOT"):
        monkeypatch.setenv(variable, name)
        with pytest.raises(ValueError, match=rf"^{variable}: a robot's name must .*got '{re.escape(name)}'$"):
            ArmSettings.from_environment()


def test_a_service_with_wrong_settings_ends_with_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setenv("TOPNAV_ROBOT", "*")
    with pytest.raises(SystemExit) as caught:
        ArmSettings.of_service("arm")
    assert caught.value.code == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("arm: TOPNAV_ROBOT: a robot's name must match")


SERVICES = (
    "dispatch",
    "drive",
    "features",
    "fleet",
    "gateway",
    "map_store",
    "planner",
    "recorder",
    "recorder.foxglove",
    "signs",
)


@pytest.mark.parametrize("module", [*(f"services.{name}" for name in SERVICES), "simulator"])
def test_every_service_with_wrong_settings_ends_with_one_line(module: str, tmp_path: Path, repository: Path):
    environment = os.environ | {"TOPNAV_ROBOT": "*", "PYTHONPATH": str(repository)}
    command = [sys.executable, "-m", module]
    ended = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
    )
    assert (ended.returncode, len(ended.stderr.splitlines())) == (2, 1), ended.stderr
    assert "TOPNAV_ROBOT: a robot's name must match" in ended.stderr


def test_settings_are_frozen():
    with pytest.raises(ValueError, match="frozen"):
        ArmSettings.from_environment().rate_hz = 1.0  # type: ignore[misc]
