"""The map store of a data folder: the running one over REST, or one started for a command; and its file."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx

from experiments.failure import one_line_errors
from experiments.map_client import token_header
from services.launcher.compose_file import COMPOSE_FILE, load_compose
from services.launcher.local import LocalMachine, local_process
from services.launcher.stack_settings import StackSettings
from services.launcher.state import StateFolder
from services.launcher.supervisor import Launcher

TIMEOUT_S = 120.0
SERVICE = "map-store"


@contextmanager
def open_store(data_dir: Path) -> Iterator[httpx.Client]:
    """A client of the running map store, or of one started for this command."""
    running = StateFolder(data_dir.resolve()).read()
    with one_line_errors():
        if running is not None:
            with _client(running.map_store_url) as client:
                yield client
            return
        with Launcher(data_dir, only=[SERVICE]) as launcher, _client(launcher.map_store_url) as client:
            yield client


def database_url(data_dir: Path) -> str:
    """Where the map store of a stack in this folder keeps its maps."""
    settings = StackSettings(data_dir.resolve())
    services = load_compose(COMPOSE_FILE, settings.variables()).services
    machine = LocalMachine(sys.executable, settings.data_dir)
    spec = local_process(SERVICE, services[SERVICE], services, machine)
    return spec.environment["MAP_STORE_DATABASE_URL"]


def _client(url: str) -> httpx.Client:
    return httpx.Client(base_url=url, headers=token_header(), timeout=TIMEOUT_S, trust_env=False)
