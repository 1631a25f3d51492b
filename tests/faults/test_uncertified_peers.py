"""Nobody takes part in a secured bus without a good certificate, and no service takes part half secured."""

import datetime as dt
import json
import os
import subprocess
import sys
import time

import pytest
import zenoh

from services.launcher.processes.free_ports import free_ports
from shared.access.credentials import FILES, Credentials, credentials_in
from shared.bus import UnreachableError, open_bus
from shared.certificates.holders import everyone
from shared.certificates.issuing import make
from shared.transport.keys import alive_key
from shared.transport.router_config import secured_router_config
from shared.transport.session_config import client_config, peer_config
from tests.faults.secured import SecuredBus

pytestmark = [pytest.mark.timeout(600)]

REFUSED_MS, ADMITTED_MS = 2_000, 30_000


@pytest.fixture(scope="module")
def secured(tmp_path_factory, repository):
    with SecuredBus(tmp_path_factory.mktemp("secured"), repository, *free_ports(2)) as bus:
        yield bus


def refused(config, patience_ms=REFUSED_MS):
    """Whether a session with these settings never gets to the router."""
    config.insert_json5("connect/timeout_ms", str(patience_ms))
    try:
        session = zenoh.open(config)
    except zenoh.ZError:
        return True
    session.close()
    return False


def admitted(config):
    """Whether it does get there, on a machine that may take long to let it."""
    return not refused(config, ADMITTED_MS)


def test_peers_without_a_certificate_of_ours_do_not_get_in(secured, tmp_path):
    ours = secured.certs / "drive"
    assert admitted(client_config(secured.endpoint, credentials_in(ours)))
    make(tmp_path / "foreign", everyone("r1"), dt.datetime.now(dt.UTC))
    foreign = credentials_in(tmp_path / "foreign" / "drive")
    assert refused(client_config(secured.endpoint, foreign)), "of another authority"
    trusting = Credentials(ours / FILES[0], foreign.certificate, foreign.key)
    assert refused(client_config(secured.endpoint, trusting)), "of another authority, trusting ours"
    nobody = client_config(secured.endpoint, credentials_in(ours))
    nobody.insert_json5("transport/link/tls", json.dumps({"root_ca_certificate": str(ours / FILES[0])}))
    assert refused(nobody), "without certificate"


def test_an_expired_certificate_does_not_get_in(tmp_path):
    """Only the client's has run out: it is renewed, and the router's authority is still good."""
    now, port = dt.datetime.now(dt.UTC), free_ports(1)[0]
    make(tmp_path, [h for h in everyone("r1") if h.name == "drive"], now - dt.timedelta(days=500))
    make(tmp_path, [h for h in everyone("r1") if h.name in ("router", "viewer")], now)
    endpoint = f"tls/127.0.0.1:{port}"
    with zenoh.open(secured_router_config(endpoint, credentials_in(tmp_path / "router"), ["r1"])):
        assert admitted(client_config(endpoint, credentials_in(tmp_path / "viewer")))
        assert refused(client_config(endpoint, credentials_in(tmp_path / "drive")))


@pytest.mark.parametrize("stolen", ["drive", "map_store"])
def test_nobody_but_the_router_is_taken_for_the_router(stolen, secured):
    """A thief listens in the router's place; the map store's certificate is that of a server, too."""
    endpoint = f"tls/127.0.0.1:{free_ports(1)[0]}"
    thief = credentials_in(secured.certs / stolen)
    with zenoh.open(secured_router_config(endpoint, thief, ["r1"])):
        assert refused(client_config(endpoint, credentials_in(secured.certs / "planner")))


def test_a_peer_without_tls_meets_nobody(secured):
    with zenoh.open(peer_config("tcp/" + secured.endpoint.partition("/")[2])) as session:
        time.sleep(1.5)
        assert list(session.info.routers_zid()) == []
        assert list(session.info.peers_zid()) == []
        assert list(session.liveliness().get(alive_key("*", "*"), timeout=1.0)) == []


STARTS = [
    pytest.param("shared.router", "router", id="router"),
    pytest.param("services.drive", "drive", id="drive"),
    pytest.param("services.map_store", "map_store", id="map store"),
    pytest.param("shared.health", "operator", id="health check"),
]


@pytest.mark.parametrize(("module", "holder"), STARTS)
@pytest.mark.parametrize("missing", ["key.pem", "certificate.pem", "authority.pem", "all"])
def test_half_a_certificate_stops_a_service_instead_of_opening_it(
    module, holder, missing, secured, tmp_path, repository
):
    """With all files missing the endpoint still asks for TLS, and a service without certificate has none."""
    for name in FILES:
        if missing not in (name, "all"):
            (tmp_path / name).write_bytes((secured.certs / holder / name).read_bytes())
    given = {
        "TOPNAV_ENDPOINT": secured.endpoint,
        "TOPNAV_ROUTER_LISTEN": f"tls/127.0.0.1:{free_ports(1)[0]}",
        "TOPNAV_CERTS": str(tmp_path),
        "MAP_STORE_DATABASE_URL": f"sqlite:///{tmp_path}/maps.sqlite3",
    }
    arguments = [sys.executable, "-m", module] + (["drive"] if module == "shared.health" else [])
    run = subprocess.run(
        arguments, cwd=repository, env=os.environ | given, capture_output=True, text=True, timeout=60
    )
    assert run.returncode == 1
    lines = run.stderr.strip().splitlines()
    assert "TOPNAV_CERTS" in lines[-1]
    assert "Traceback" not in run.stderr
    if missing != "all":
        assert f"{missing} missing" in lines[-1]


def test_a_service_whose_certificate_the_router_refuses_says_so(secured, tmp_path):
    make(tmp_path, everyone("r1"), dt.datetime.now(dt.UTC))
    foreign = open_bus(secured.endpoint, certs=tmp_path / "drive")
    with pytest.raises(UnreachableError, match="takes the certificate"), foreign:
        pass
