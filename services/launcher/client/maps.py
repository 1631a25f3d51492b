"""Maps as commands need them: read over the bus; listed, moved and deleted over REST."""

import os
import ssl
import sys
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from http import HTTPStatus
from pathlib import Path

import httpx

from services.launcher.client.failure import ExperimentError, one_line_errors
from services.launcher.client.stack import Stack
from services.launcher.compose.compose_file import COMPOSE_FILE, load_compose
from services.launcher.compose.local import LocalMachine, local_process
from services.launcher.processes.stack_settings import StackSettings
from services.launcher.processes.state import StateFolder
from services.launcher.processes.supervisor import Launcher
from shared.access.credentials import MAP_STORE_HOST, credentials_in
from shared.access.tokens import kept_secret
from shared.messages.maps import MapReply, MapRequest
from shared.queries import RefusedError
from shared.topics import MAP

ASK_TIMEOUT_S = 30.0
"""Reading a map of 1000 nodes takes a second; a store that is just opening one may be slower."""

REST_TIMEOUT_S = 120.0
"""Checking or importing a large map is one request."""

SERVICE = "map-store"
KEPT_SECRET = Path("token/token")
"""In a data folder: MAP_STORE_TOKEN_FILE of docker-compose.yml there."""


def read_map(stack: Stack, name: str) -> MapReply | None:
    """Nodes and edges of a map; None when there is no such map, ExperimentError when it cannot be read."""
    try:
        return stack.bus.ask(MAP, MapRequest(action="read"), ASK_TIMEOUT_S, map=name)
    except RefusedError as error:
        if not error.may_be_missing:
            raise ExperimentError(str(error)) from error
        return None


def require_map(stack: Stack, name: str) -> MapReply:
    """Nodes and edges of a map that must have some; raises ExperimentError."""
    found = read_map(stack, name)
    if found is None or not found.nodes:
        raise ExperimentError(f"no map {name!r} here: make it with 'topnav explore --map {name}'")
    return found


def delete_map(stack: Stack, name: str) -> None:
    """Delete a map with its history; raises ExperimentError where the gateway's address is not known."""
    if stack.gateway_url is None:
        raise ExperimentError(f"cannot delete map {name!r} without the gateway: name the stack by --data-dir")
    url = f"{stack.gateway_url}/api/maps/{name}"
    httpx.delete(url, headers=token_header(), timeout=ASK_TIMEOUT_S, trust_env=False).raise_for_status()


def token_header() -> dict[str, str]:
    """The header that writes need when the stack has a token (TOPNAV_TOKEN)."""
    token = os.environ.get("TOPNAV_TOKEN", "")
    return {"Authorization": f"Bearer {token}"} if token else {}


@contextmanager
def open_store(data_dir: Path) -> Iterator[httpx.Client]:
    """A client of the running map store, or of one started for this command."""
    running = StateFolder(data_dir.resolve()).read()
    with one_line_errors():
        if running is not None:
            with store_client(running.map_store_url, running.certs, data_dir) as client:
                yield client
            return
        with (
            Launcher(data_dir, only=[SERVICE]) as launcher,
            store_client(launcher.map_store_url, data_dir=data_dir) as client,
        ):
            yield client


def store_client(url: str, certs: Path | None = None, data_dir: Path | None = None) -> httpx.Client:
    """A client of a map store; on a secured stack it shows the certificate in the folder `certs`.

    It has the secret that the map store of a stack in `data_dir` may have made, which its owner can read.
    """
    credentials = credentials_in(certs)
    client = httpx.Client(
        base_url=url,
        headers=token_header(),
        auth=_Secrets(data_dir) if data_dir is not None else None,
        timeout=REST_TIMEOUT_S,
        trust_env=False,
        verify=credentials.tls_context(ssl.Purpose.SERVER_AUTH) if credentials else True,
    )
    if credentials:
        client.event_hooks = {"request": [_expect_the_map_store]}
    return client


class _Secrets(httpx.Auth):
    """The secret of a data folder, which may be of an earlier start, then the one that is in force now."""

    def __init__(self, data_dir: Path) -> None:
        self._path = data_dir / KEPT_SECRET

    def auth_flow(self, request: httpx.Request) -> Generator[httpx.Request, httpx.Response, None]:
        """Send the request, a second time where the first secret is not taken."""
        chosen = request.headers.get("authorization")
        if self._path.exists():
            request.headers["authorization"] = f"Bearer {kept_secret(self._path)}"
        answer = yield request
        if answer.status_code == HTTPStatus.UNAUTHORIZED and chosen is not None:
            request.headers["authorization"] = chosen
            yield request


def post_archive(store: httpx.Client, archive: bytes, name: str | None) -> str:
    """Put an exported map into a map store, as `name` or its own; returns the name."""
    params = {"name": name} if name is not None else {}
    headers = {"Content-Type": "application/zip"}
    answer = store.post("/maps/import", params=params, headers=headers, content=archive)
    return str(answer.raise_for_status().json()["name"])


def database_url(data_dir: Path) -> str:
    """Where the map store of a stack in this folder keeps its maps."""
    settings = StackSettings(data_dir.resolve())
    services = load_compose(COMPOSE_FILE, settings.variables()).services
    machine = LocalMachine(sys.executable, settings.data_dir)
    spec = local_process(SERVICE, services[SERVICE], services, machine)
    return spec.environment["MAP_STORE_DATABASE_URL"]


def _expect_the_map_store(request: httpx.Request) -> None:
    """Its certificate is compared with this name instead of the address."""
    request.extensions = {**request.extensions, "sni_hostname": MAP_STORE_HOST}
