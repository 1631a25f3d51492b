"""Who may use REST: tokens, names of this machine, pages of others; addresses that need a token to start."""

from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from pydantic import ValidationError

from services.gateway.settings import GatewaySettings
from services.map_store.settings import MapStoreSettings
from services.map_store.store import MapStore
from shared.web.origins import LOOPBACK_NAMES
from tests.unit.services.map_store.conftest import app_of

SECRET = "a long enough secret"
BEARER = {"Authorization": f"Bearer {SECRET}"}


def test_where_reading_is_guarded_only_the_health_needs_no_token(store: MapStore):
    client = TestClient(app_of(store, token=SECRET, guard_reading=True))
    for path in ("/maps", "/maps/flat/nodes", "/maps/flat/export", "/check"):
        refused = client.get(path)
        assert (refused.status_code, refused.headers["www-authenticate"]) == (401, "Bearer")
        assert client.get(path, headers=BEARER).status_code == 200
    assert client.get("/healthz").status_code == 200


@pytest.mark.parametrize("host", ["127.0.0.1:8001", "localhost", "[::1]:8001"])
def test_names_of_this_machine_lead_here(store: MapStore, host: str):
    client = TestClient(app_of(store, names=LOOPBACK_NAMES))
    assert client.get("/maps", headers={"host": host}).status_code == 200


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8001", "127.0.0.1.evil.example", "", "["])
def test_a_name_pointed_at_this_machine_reads_and_writes_nothing(store: MapStore, host: str):
    client = TestClient(app_of(store, names=LOOPBACK_NAMES))
    headers = {"host": host, "origin": f"http://{host}"}
    assert client.get("/maps", headers=headers).status_code == 403
    assert client.delete("/maps/flat", headers=headers).status_code == 403
    assert [record.name for record in store.summaries()] == ["flat"]


@pytest.mark.parametrize("host", ["0.0.0.0", "192.168.1.5", "::", "map-store"])
def test_a_reachable_address_needs_a_token_or_an_explicit_wish(host: str):
    with pytest.raises(ValidationError, match="MAP_STORE_TOKEN is empty"):
        MapStoreSettings(host=host)
    with pytest.raises(ValidationError, match="at least 16 characters"):
        MapStoreSettings(host=host, token="change-me")
    assert not MapStoreSettings(host=host, token=SECRET).loopback
    assert not MapStoreSettings(host=host, allow_open=True).loopback


def test_on_loopback_a_secret_is_made_where_people_need_tokens_and_one_that_was_chosen_stays(tmp_path: Path):
    kept = {"token_file": tmp_path / "token"}
    tokens = {"tokens_file": tmp_path / "tokens.json"}
    assert not MapStoreSettings(**kept).with_kept_secret().token.get_secret_value()
    assert (
        MapStoreSettings(**kept, **tokens, token=SECRET).with_kept_secret().token.get_secret_value() == SECRET
    )
    assert not kept["token_file"].exists()
    made = MapStoreSettings(**kept, **tokens).with_kept_secret().token.get_secret_value()
    assert made == kept["token_file"].read_text()
    gateway = GatewaySettings(**kept, **tokens).with_kept_secret()
    assert gateway.map_store_token.get_secret_value() == made
    assert not gateway.token.get_secret_value(), "the secret is none of a person"
