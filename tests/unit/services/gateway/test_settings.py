"""Settings that would open the robot to the network are refused."""

import pytest
from pydantic import ValidationError

from services.gateway.settings import GatewaySettings


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.5", "::", "robot.lan"])
def test_a_reachable_address_needs_a_token(host: str) -> None:
    with pytest.raises(ValidationError, match="GATEWAY_TOKEN is empty"):
        GatewaySettings(host=host)


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "::1"])
def test_loopback_needs_none(host: str) -> None:
    assert GatewaySettings(host=host).loopback


def test_a_token_a_token_file_or_an_explicit_wish_opens_it() -> None:
    assert not GatewaySettings(host="0.0.0.0", token="3f" * 16).loopback  # type: ignore[arg-type]
    assert not GatewaySettings(host="0.0.0.0", tokens_file="tokens.json").loopback  # type: ignore[arg-type]
    assert not GatewaySettings(host="0.0.0.0", allow_open=True).loopback


@pytest.mark.parametrize("token", ["change-me", "Password", "short", "x" * 15])
def test_off_loopback_a_secret_that_anybody_would_try_is_none(token: str) -> None:
    with pytest.raises(ValidationError, match="GATEWAY_TOKEN must be a secret of at least 16 characters"):
        GatewaySettings(host="0.0.0.0", token=token)  # type: ignore[arg-type]
    assert GatewaySettings(host="127.0.0.1", token=token).loopback  # type: ignore[arg-type]


def test_reading_is_guarded_off_loopback_unless_said_otherwise() -> None:
    assert GatewaySettings(host="0.0.0.0", allow_open=True).reading_guarded
    assert not GatewaySettings().reading_guarded
    assert GatewaySettings(guard_reading=True).reading_guarded
    assert not GatewaySettings(host="0.0.0.0", allow_open=True, guard_reading=False).reading_guarded


def test_a_token_file_that_compose_leaves_empty_is_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GATEWAY_TOKENS_FILE", "")
    assert GatewaySettings.from_environment().tokens_file is None


def test_the_environment_is_read_and_misspelt_names_are_errors(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GATEWAY_PORT", "9000")
    monkeypatch.setenv("GATEWAY_MAP_STORE_URL", "http://store:8001")
    settings = GatewaySettings.from_environment()
    assert (settings.port, str(settings.map_store_url)) == (9000, "http://store:8001/")
    monkeypatch.setenv("GATEWAY_PROT", "1")
    with pytest.raises(ValueError, match="GATEWAY_PROT: no such setting"):
        GatewaySettings.from_environment()


def test_the_token_does_not_show_in_logs() -> None:
    assert "secret" not in repr(GatewaySettings(token="secret"))  # type: ignore[arg-type]
