"""A server beside a service's own loop: answers while the block runs, says when it cannot start."""

import re
import socket
import threading
import time
from contextlib import suppress

import httpx
import pytest
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse
from starlette.routing import Route

from services.launcher.processes.free_ports import free_ports
from shared.web.crowding import ConnectionLimits
from shared.web.server import serving

HOST = "127.0.0.1"
LIMITS = ConnectionLimits(header_s=30.0, unread_s=30.0, most=64, most_per_client=8)
SLOW_S = 60.0


def hello(_request: Request) -> PlainTextResponse:
    return PlainTextResponse("hello")


@pytest.fixture
def app() -> Starlette:
    return Starlette(routes=[Route("/", hello)])


def test_it_answers_while_the_block_runs_and_not_after(app: Starlette) -> None:
    (port,) = free_ports(1)
    with serving(app, HOST, port, LIMITS, stop=threading.Event(), grace_s=1) as thread:
        assert httpx.get(f"http://{HOST}:{port}/", trust_env=False, timeout=SLOW_S).text == "hello"
        assert thread.is_alive()
    thread.join(SLOW_S)
    with pytest.raises(httpx.ConnectError):
        httpx.get(f"http://{HOST}:{port}/", trust_env=False, timeout=SLOW_S)


def test_a_taken_port_is_an_error(app: Starlette) -> None:
    with socket.create_server((HOST, 0)) as taken:
        port = taken.getsockname()[1]
        with (
            pytest.raises(RuntimeError, match=f"no HTTP on {HOST}:{port}: see the log"),
            serving(app, HOST, port, LIMITS, stop=threading.Event(), grace_s=1),
        ):
            pass


def has_ipv6() -> bool:
    """Whether this machine has the loopback address ::1: containers often do not."""
    with suppress(OSError), socket.create_server(("::1", 0), family=socket.AF_INET6):
        return True
    return False


@pytest.mark.skipif(not has_ipv6(), reason="no IPv6 here")
def test_an_ipv6_address_stands_in_brackets_in_what_is_logged(
    app: Starlette, caplog: pytest.LogCaptureFixture
) -> None:
    with caplog.at_level("INFO"), serving(app, "::1", 0, LIMITS, stop=threading.Event(), grace_s=1):
        assert re.search(r"serving on http://\[::1\]:\d+$", caplog.text, re.MULTILINE)


def test_who_is_told_to_stop_while_it_starts_does_not_wait() -> None:
    """The application never ends its start."""
    stop, began = threading.Event(), threading.Event()

    async def hung(scope: dict[str, object], receive: object, _send: object) -> None:
        assert scope["type"] == "lifespan"
        began.set()
        await receive()  # type: ignore[operator]
        await receive()  # type: ignore[operator]

    threading.Thread(target=lambda: began.wait() and stop.set(), daemon=True).start()
    began_s = time.monotonic()
    with serving(hung, HOST, 0, LIMITS, stop=stop, grace_s=1):  # type: ignore[arg-type]
        assert stop.is_set()
        assert time.monotonic() - began_s < 20.0, "not as long as a start may take"
