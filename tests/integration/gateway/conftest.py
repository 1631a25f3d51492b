"""A router, stand-in neighbours and the gateway itself on free ports."""

import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
import zenoh
from PIL import Image

from services.gateway.service import run
from services.gateway.settings import GatewaySettings
from shared.bus import Bus, open_bus, wait_until
from shared.bus_config import router_config
from tests.integration.gateway.corpus import saved
from tests.integration.gateway.gateway_process import UNHURRIED, Process, answers, free_port, send, started
from tests.integration.gateway.standins import FeatureService, Peer, Planner, served, store_app

Stored = tuple[int, list[tuple[str, str]]]
"""The map store's port and what it was asked: method and path."""


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
    store = f"http://127.0.0.1:{stored[0]}"
    yield from serve_gateway(endpoint, map_store_url=store, max_upload_bytes=2_000_000)


@pytest.fixture(scope="module")
def process(
    endpoint: str, features: FeatureService, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Process]:
    """The gateway as a process, beside a feature service; it has decoded a picture before."""
    assert features
    running = started(endpoint, tmp_path_factory.mktemp("gateway"))
    assert send(running, "image/png", saved(Image.new("RGB", (256, 128)), "PNG")).status_code == 200
    yield running
    running.process.terminate()
    assert running.process.wait(10.0) == 0


@pytest.fixture
def http(gateway: str) -> Iterator[httpx.Client]:
    """A client of the gateway."""
    with httpx.Client(base_url=gateway, trust_env=False, timeout=20.0) as client:
        yield client


def serve_gateway(endpoint: str, **changes: object) -> Iterator[str]:
    """Run the real service loop on a thread; runs go to a folder of its own unless one is named."""
    with tempfile.TemporaryDirectory() as folder:
        yield from _serve(endpoint, **{"runs_dir": Path(folder), **changes})


def _serve(endpoint: str, **changes: object) -> Iterator[str]:
    port, stop = int(str(changes.pop("port", 0))) or free_port(), threading.Event()
    settings = GatewaySettings(endpoint=endpoint, port=port, **{**UNHURRIED, **changes})  # type: ignore[arg-type]

    def serve() -> None:
        with open_bus(endpoint) as bus:
            run(settings, bus, stop)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    address = f"http://127.0.0.1:{port}"
    assert wait_until(lambda: answers(address), 10.0)
    yield address
    stop.set()
    thread.join(10.0)
