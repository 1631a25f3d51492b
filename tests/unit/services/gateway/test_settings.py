"""Settings that would open the robot to the network are refused."""

from pathlib import Path

import pytest
from pydantic import SecretStr, ValidationError

from services.gateway.settings import GatewaySettings
from services.map_store.settings import MapStoreSettings
from shared.settings import ServiceSettings


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


@pytest.mark.parametrize(
    ("settings", "prefix"), [(GatewaySettings, "GATEWAY_"), (MapStoreSettings, "MAP_STORE_")]
)
def test_a_refused_secret_stands_in_no_log(
    monkeypatch: pytest.MonkeyPatch, settings: type[ServiceSettings], prefix: str
) -> None:
    monkeypatch.setenv(f"{prefix}HOST", "0.0.0.0")
    monkeypatch.setenv(f"{prefix}TOKEN", "hunter2hunter2")
    with pytest.raises(ValueError, match=f"{prefix}TOKEN must be a secret of at least 16") as refused:
        settings.from_environment()
    assert "hunter2" not in str(refused.value)
    assert "\n" not in str(refused.value)


def test_without_a_secret_one_is_made_that_gateway_and_map_store_share(tmp_path: Path) -> None:
    file = tmp_path / "token"
    gateway = GatewaySettings(host="0.0.0.0", token_file=file).with_kept_secret()
    store = MapStoreSettings(host="0.0.0.0", token_file=file).with_kept_secret()
    secret = file.read_text()
    assert {gateway.token.get_secret_value(), gateway.map_store_token.get_secret_value()} == {secret}
    assert store.token.get_secret_value() == secret


def test_a_secret_that_was_chosen_stays_and_on_loopback_none_is_made(tmp_path: Path) -> None:
    file, chosen = tmp_path / "token", SecretStr("3f" * 16)
    gateway = GatewaySettings(host="0.0.0.0", token=chosen, map_store_token=chosen, token_file=file)
    assert gateway.with_kept_secret().token == gateway.with_kept_secret().map_store_token == chosen
    assert MapStoreSettings(host="0.0.0.0", token=chosen, token_file=file).with_kept_secret().token == chosen
    named = GatewaySettings(host="0.0.0.0", tokens_file=tmp_path / "tokens.json", token_file=file)
    assert named.with_kept_secret().token.get_secret_value() == "", (
        "the tokens with names are those that count"
    )
    file.unlink()
    assert GatewaySettings(token_file=file).with_kept_secret().token.get_secret_value() == ""
    assert not file.exists()
