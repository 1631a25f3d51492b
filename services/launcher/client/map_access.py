"""The map store of a data folder: the running one over REST, or one started for a command; and its file."""

import ssl
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import httpx

from services.launcher.client.failure import one_line_errors
from services.launcher.client.map_client import token_header
from services.launcher.processes.compose_file import COMPOSE_FILE, load_compose
from services.launcher.processes.local import LocalMachine, local_process
from services.launcher.processes.stack_settings import StackSettings
from services.launcher.processes.state import StateFolder
from services.launcher.processes.supervisor import Launcher
from shared.access.credentials import MAP_STORE_HOST, credentials_in

TIMEOUT_S = 120.0
SERVICE = "map-store"


@contextmanager
def open_store(data_dir: Path) -> Iterator[httpx.Client]:
    """A client of the running map store, or of one started for this command."""
    running = StateFolder(data_dir.resolve()).read()
    with one_line_errors():
        if running is not None:
            with store_client(running.map_store_url, running.operator_certs) as client:
                yield client
            return
        with Launcher(data_dir, only=[SERVICE]) as launcher, store_client(launcher.map_store_url) as client:
            yield client


def database_url(data_dir: Path) -> str:
    """Where the map store of a stack in this folder keeps its maps."""
    settings = StackSettings(data_dir.resolve())
    services = load_compose(COMPOSE_FILE, settings.variables()).services
    machine = LocalMachine(sys.executable, settings.data_dir)
    spec = local_process(SERVICE, services[SERVICE], services, machine)
    return spec.environment["MAP_STORE_DATABASE_URL"]


def store_client(url: str, certs: Path | None = None) -> httpx.Client:
    """A client of a map store; on a secured stack it shows the certificate in the folder `certs`."""
    credentials = credentials_in(certs)
    client = httpx.Client(
        base_url=url,
        headers=token_header(),
        timeout=TIMEOUT_S,
        trust_env=False,
        verify=credentials.tls_context(ssl.Purpose.SERVER_AUTH) if credentials else True,
    )
    if credentials:
        client.event_hooks = {"request": [_expect_the_map_store]}
    return client


def _expect_the_map_store(request: httpx.Request) -> None:
    """Its certificate is compared with this name instead of the address."""
    request.extensions = {**request.extensions, "sni_hostname": MAP_STORE_HOST}
