"""A gateway that asks for tokens, stand-ins of its neighbours behind it, MCP servers before it."""

import asyncio
import os
import socket
import subprocess
import sys
import time
from collections.abc import Awaitable, Callable, Iterator
from contextlib import AsyncExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import httpx
import pytest
from mcp import Client, StdioServerParameters
from mcp.client.streamable_http import create_mcp_http_client, streamable_http_client

from shared.bus import Bus, wait_until
from shared.estop.sides import EStopServer
from tests.integration.gateway.conftest import (  # noqa: F401
    endpoint,
    features,
    patient_stops,
    planner,
    robot_bus,
    serve_gateway,
)
from tests.integration.gateway.gateway_process import ASK_S, WAIT_S, free_port
from tests.integration.gateway.keys import SECRETS, bearer, write_file
from tests.integration.gateway.standins import FeatureService, Peer, Planner
from tests.integration.gateway.standins import served as serve_app
from tests.integration.gateway.test_evidence import send_frame
from tests.integration.mcp.kept import Kept, kept_in

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(scope="module")
def drive(endpoint: str, tmp_path_factory: pytest.TempPathFactory) -> Iterator[list[EStopServer]]:  # noqa: F811
    """A drive service that only knows the emergency stop."""
    made: list[EStopServer] = []

    def setup(bus: Bus) -> Callable[[], None]:
        made.append(EStopServer(bus, "r1", tmp_path_factory.mktemp("drive")))
        return lambda: made[0].step(time.monotonic())

    with Peer(endpoint, "drive", setup):
        yield made


@pytest.fixture(scope="module")
def kept(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Kept]:
    """The map store's database, its queue and its REST interface."""
    with kept_in(tmp_path_factory.mktemp("maps")) as opened:
        yield opened


@pytest.fixture(scope="module")
def guarded(
    endpoint: str,  # noqa: F811
    kept: Kept,
    features: FeatureService,  # noqa: ARG001, F811
    planner: Planner,  # noqa: ARG001, F811
    robot_bus: Bus,  # noqa: F811
    drive: list[EStopServer],
    patient_stops: None,  # noqa: ARG001, F811
    tmp_path_factory: pytest.TempPathFactory,
) -> Iterator[str]:
    """The gateway's address; a robot has sent a picture."""
    assert drive
    tokens = write_file(tmp_path_factory.mktemp("tokens") / "tokens.json")
    beside = ("features", "planner", "map_store", "drive")
    with serve_app(kept.app) as port, Peer(endpoint, "map_store", kept.setup):
        store = f"http://127.0.0.1:{port}"
        settings = {"tokens_file": tokens, "guard_reading": True, "map_store_url": store}
        for address in serve_gateway(endpoint, beside, **settings):
            with httpx.Client(base_url=address, headers=bearer("viewer"), trust_env=False) as http:
                send_frame(http, robot_bus, 5)
            yield address


def environment(gateway: str, **settings: str) -> dict[str, str]:
    """Of a server before that gateway; nothing of whoever runs the tests."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("MCP_", "TOPNAV_"))}
    return {**kept, "PYTHONPATH": str(ROOT), "MCP_GATEWAY_URL": gateway, **settings}


def by_stdio(gateway: str, role: str | None, **settings: str) -> StdioServerParameters:
    """A server of its own for one program, with the token of that role."""
    token = {} if role is None else {"MCP_TOKEN": SECRETS[role]}
    shell = environment(gateway, **token, **settings)
    return StdioServerParameters(command=sys.executable, args=["-m", "services.mcp"], env=shell)


@pytest.fixture(scope="module")
def served(guarded: str) -> Iterator[str]:
    """Address of a server over HTTP."""
    port = free_port()
    shell = environment(guarded, MCP_TRANSPORT="http", MCP_PORT=str(port))
    process = subprocess.Popen([sys.executable, "-m", "services.mcp"], env=shell)
    address = f"http://127.0.0.1:{port}/mcp"
    try:
        assert wait_until(lambda: _listens(port), 2 * WAIT_S)
        yield address
    finally:
        process.terminate()
        process.wait(WAIT_S)


@dataclass(frozen=True)
class ByHttp:
    """A program that shows the token of that role, if any, to a server at that address."""

    address: str
    role: str | None


def during(server: StdioServerParameters | ByHttp, errand: Callable[[Client], Awaitable[Any]]) -> Any:
    """What an errand of the official client brings back."""

    async def run() -> Any:
        async with asyncio.timeout(2 * ASK_S), AsyncExitStack() as opened:
            reached: Any = server
            if isinstance(server, ByHttp):
                http = await opened.enter_async_context(create_mcp_http_client(headers=bearer(server.role)))
                reached = streamable_http_client(server.address, http_client=http)
            return await errand(await opened.enter_async_context(Client(reached)))

    return asyncio.run(run())


def _listens(port: int) -> bool:
    try:
        socket.create_connection(("127.0.0.1", port)).close()
    except OSError:
        return False
    return True
