"""Fixtures that any test may use."""

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zenoh

from services.launcher.processes.free_ports import free_ports
from shared.transport import session_config as bus_config
from shared.transport.router_config import router_config
from tests import patient
from tests.plane_exploration import Explorations
from tests.postgres import PostgresServer, missing
from tests.traced_memory import TracedCall, tracing_process

REPOSITORY = Path(__file__).resolve().parents[1]


LONGEST_FIRST = ("tests/e2e", "tests/integration", "tests")
"""In this order workers take files, so that no long one is left for the end."""


@pytest.hookimpl(optionalhook=True)  # of pytest-xdist, which `make test` runs with
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Distribute tests by file; those of a shared stack together."""
    from tests.scheduling import ByStackAndFile

    config.option.loadscopereorder = False
    return ByStackAndFile(config, log)


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Put what waits longest first."""

    def rank(item: pytest.Item) -> int:
        nodeid = item.nodeid
        return next((k for k, folder in enumerate(LONGEST_FIRST) if nodeid.startswith(f"{folder}/")), 0)

    items.sort(key=rank)


@pytest.fixture(scope="session")
def repository() -> Path:
    """Folder of the whole project."""
    return REPOSITORY


@pytest.fixture(scope="session")
def explorations(tmp_path_factory: pytest.TempPathFactory) -> Explorations:
    """The apartment explored on the true floor plan, by seed; the workers of a run share what one made."""
    own = tmp_path_factory.getbasetemp()
    return Explorations(own.parent if "PYTEST_XDIST_WORKER" in os.environ else own)


@pytest.fixture
def rng() -> np.random.Generator:
    """Random numbers that are the same in every run."""
    return np.random.default_rng(seed=7)


@pytest.fixture(scope="session")
def traced_call() -> Iterator[TracedCall]:
    """Calls a function of a module in another process, and tells its peak of memory in bytes."""
    with tracing_process() as traced:
        yield traced


@pytest.fixture
def free_port() -> Callable[[], int]:
    """Call it for a TCP port on loopback that nobody uses now, nor gets by chance before it is used."""
    return lambda: free_ports(1)[0]


@pytest.fixture(scope="module")
def patient_sessions() -> Iterator[None]:
    """Sessions that this process opens outlive a pause of it, as those of `tests.patient` do."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(bus_config, "LEASE_MS", patient.LEASE_MS)
        yield


@pytest.fixture(scope="session")
def postgres() -> Iterator[PostgresServer]:
    """A PostgreSQL server for all tests that ask for one; they are skipped where none is installed."""
    if why := missing():
        pytest.skip(why)
    server = PostgresServer()
    try:
        server.start()
        yield server
    finally:
        server.close()


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    """A headless Chromium; tests of the console are skipped as a whole where there is none."""
    from tests.browser import chromium  # skips whoever imports it where playwright is not installed

    with chromium() as opened:
        yield opened


@pytest.fixture
def router_endpoint(free_port: Callable[[], int]) -> Iterator[str]:
    """Endpoint of a Zenoh router that lives as long as the test."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    with zenoh.open(router_config(endpoint)):
        yield endpoint
