"""A router, stand-in neighbours and the gateway itself on free ports."""

import tempfile
import threading
from collections.abc import Collection, Iterator
from pathlib import Path

import httpx
import pytest
import zenoh
from PIL import Image

from services.gateway.routes import estop
from services.gateway.service import run
from services.gateway.settings import GatewaySettings
from shared.bus import Bus, open_bus, wait_until
from shared.transport.router_config import router_config
from tests.integration.gateway.corpus import saved
from tests.integration.gateway.gateway_process import (
    ASK_S,
    UNHURRIED,
    WAIT_S,
    Process,
    free_port,
    sees,
    send,
    started,
)
from tests.integration.gateway.standins import FeatureService, MapStore, Peer, Planner, served, store_app

Stored = tuple[int, list[tuple[str, str]]]
"""The map store's port and what it was asked: method and path."""


@pytest.fixture(scope="module", autouse=True)
def _patient(patient_sessions: None) -> None:
    """Nobody is given up for standing still; `process` is patient, too."""


@pytest.fixture(scope="module")
def endpoint() -> Iterator[str]:
    """A router."""
    address = f"tcp/127.0.0.1:{free_port()}"
    router = zenoh.open(router_config(address))
    yield address
    router.close()


@pytest.fixture(scope="module")
def robot_bus(endpoint: str) -> Iterator[Bus]:
    """The session of a robot or of whoever else speaks."""
    with open_bus(endpoint) as bus:
        yield bus


@pytest.fixture(scope="module")
def features(endpoint: str) -> Iterator[FeatureService]:
    """The feature service's stand-in."""
    service = FeatureService()
    with Peer(endpoint, "features", service.setup):
        yield service


@pytest.fixture
def map_store(endpoint: str, gateway: str) -> Iterator[None]:
    """The map store on the bus, where the gateway has met it."""
    with Peer(endpoint, "map_store", MapStore().setup):
        assert wait_until(lambda: sees(gateway, ["map_store"]), WAIT_S)
        yield


@pytest.fixture(scope="module")
def planner(endpoint: str) -> Iterator[Planner]:
    """The planner's stand-in."""
    service = Planner()
    with Peer(endpoint, "planner", service.setup):
        yield service


@pytest.fixture(scope="module")
def stored() -> Iterator[Stored]:
    """The map store's stand-in: its port and what it was asked."""
    seen: list[tuple[str, str]] = []
    with served(store_app(seen, nodes=5)) as port:
        yield port, seen


@pytest.fixture(scope="module")
def gateway(endpoint: str, stored: Stored, features: FeatureService, planner: Planner) -> Iterator[str]:
    """The gateway's address; its neighbours are up before it."""
    assert features
    assert planner
    store, beside = f"http://127.0.0.1:{stored[0]}", ("features", "planner")
    yield from serve_gateway(endpoint, beside, map_store_url=store, max_upload_bytes=2_000_000)


@pytest.fixture(scope="module")
def process(
    endpoint: str, features: FeatureService, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Process]:
    """The gateway as a process, beside a feature service; it has decoded a picture before."""
    assert features
    running = started(endpoint, tmp_path_factory.mktemp("gateway"), ["features"])
    try:
        assert send(running, "image/png", saved(Image.new("RGB", (256, 128)), "PNG")).status_code == 200
        yield running
    finally:
        running.end()


@pytest.fixture(scope="module")
def patient_stops() -> Iterator[None]:
    """Gateways wait for a drive service that stands still for a while."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(estop, "TIMEOUT_S", WAIT_S)
        yield


@pytest.fixture
def http(gateway: str) -> Iterator[httpx.Client]:
    """A client of the gateway."""
    with httpx.Client(base_url=gateway, trust_env=False, timeout=ASK_S) as client:
        yield client


def serve_gateway(endpoint: str, beside: Collection[str] = (), **changes: object) -> Iterator[str]:
    """Run the real service loop on a thread until it has met the services that run `beside` it.

    Runs go to a folder of its own unless one is named.
    """
    with tempfile.TemporaryDirectory() as folder:
        yield from _serve(endpoint, beside, **{"runs_dir": Path(folder), **changes})


def _serve(endpoint: str, beside: Collection[str], **changes: object) -> Iterator[str]:
    port, stop = int(str(changes.pop("port", 0))) or free_port(), threading.Event()
    chosen = {**UNHURRIED, "ask_timeout_s": WAIT_S, "compute_timeout_s": WAIT_S, **changes}
    settings = GatewaySettings(endpoint=endpoint, port=port, **chosen)  # type: ignore[arg-type]

    def serve() -> None:
        with open_bus(endpoint) as bus:
            run(settings, bus, stop)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    address = f"http://127.0.0.1:{port}"
    try:
        assert wait_until(lambda: sees(address, beside), WAIT_S)
        yield address
    finally:
        stop.set()
        thread.join(WAIT_S)
