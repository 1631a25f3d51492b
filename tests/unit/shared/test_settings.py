"""Settings: from the environment, frozen, and a misspelt name is an error that lists the right ones."""

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


def test_settings_are_frozen():
    with pytest.raises(ValueError, match="frozen"):
        ArmSettings.from_environment().rate_hz = 1.0  # type: ignore[misc]
