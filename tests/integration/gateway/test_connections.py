"""Connections that stall or are too many: ended or refused, while others are served."""

import asyncio
import contextlib
import socket
import time
from collections.abc import Iterator

import httpx
import pytest
from fastapi import FastAPI, Request

from shared.bus import wait_until
from tests.integration.gateway import standins
from tests.integration.gateway.conftest import serve_gateway

HEADER_S = 3.0
"""Longer than a client that is about to send may stand still on a busy machine."""
PER_CLIENT = 12
MUST_END_S = 30.0
"""Long, for busy machines: without a time-out nothing would end at all."""


@pytest.fixture(scope="module")
def slow_store() -> Iterator[str]:
    """A map store that thinks for longer than the head of a request may take."""
    app = FastAPI()

    @app.get("/maps")
    async def maps() -> list[str]:
        await asyncio.sleep(1.5 * HEADER_S)
        return []

    @app.post("/maps/import")
    async def take(request: Request) -> list[str]:
        await request.body()
        return []

    with standins.served(app) as port:
        yield f"http://127.0.0.1:{port}"


@pytest.fixture(scope="module")
def impatient(endpoint: str, slow_store: str) -> Iterator[str]:
    """A gateway that waits three seconds for the head of a request or the next part of a body."""
    yield from serve_gateway(
        endpoint, header_timeout_s=HEADER_S, upload_timeout_s=2.0, map_store_url=slow_store
    )


@pytest.fixture(scope="module")
def narrow(endpoint: str) -> Iterator[str]:
    """A gateway for a few connections of one address, which says nothing for long."""
    yield from serve_gateway(endpoint, header_timeout_s=120.0, max_connections_per_client=PER_CLIENT)


def opened(address: str, source: str = "127.0.0.1") -> socket.socket:
    host, port = address.removeprefix("http://").split(":")
    return socket.create_connection((host, int(port)), timeout=MUST_END_S, source_address=(source, 0))


def ended_while_trickling(sender: socket.socket, drop: bytes) -> bool:
    """Whether the other side ends the connection though a byte comes now and then."""
    sender.settimeout(0.3)
    deadline_s = time.monotonic() + MUST_END_S
    while time.monotonic() < deadline_s:
        try:
            sender.sendall(drop)
            if sender.recv(65_536) == b"":
                return True
        except TimeoutError:
            continue
        except OSError:
            return True
    return False


def served(address: str, source: str = "127.0.0.1") -> bool:
    transport = httpx.HTTPTransport(local_address=source)
    with httpx.Client(transport=transport, timeout=MUST_END_S) as client:
        return client.get(f"{address}/healthz").status_code == 200


@pytest.mark.parametrize("head", [b"", b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: "])
def test_a_head_that_never_ends_ends_the_connection(impatient: str, head: bytes) -> None:
    with contextlib.closing(opened(impatient)) as sender:
        sender.sendall(head)
        assert ended_while_trickling(sender, b"x")


def test_what_trickles_in_after_an_answer_does_not_keep_a_connection(impatient: str) -> None:
    with contextlib.closing(opened(impatient)) as sender:
        sender.sendall(b"POST /nowhere HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 100000\r\n\r\n")
        assert b" 404 " in sender.recv(4096)
        assert ended_while_trickling(sender, b"x")


def test_a_request_that_waits_for_its_answer_is_not_ended(impatient: str) -> None:
    began_s = time.monotonic()
    answer = httpx.get(f"{impatient}/api/maps", trust_env=False, timeout=MUST_END_S)
    assert (answer.status_code, answer.json()) == (200, [])
    assert time.monotonic() - began_s > HEADER_S


def test_an_archive_that_stops_flowing_is_refused(impatient: str) -> None:
    with contextlib.closing(opened(impatient)) as sender:
        sender.sendall(
            b"POST /api/maps/import HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/zip\r\n"
            b"Content-Length: 1000000\r\n\r\nPK"
        )
        assert b" 408 " in sender.recv(4096)


def test_whoever_says_nothing_makes_room_for_one_who_comes(narrow: str) -> None:
    with contextlib.ExitStack() as stack:
        idle = [stack.enter_context(contextlib.closing(opened(narrow))) for _ in range(PER_CLIENT)]
        assert served(narrow), "from the same address"
        idle[0].settimeout(MUST_END_S)
        with contextlib.suppress(ConnectionError):
            assert idle[0].recv(1) == b"", "the one that waited longest"
        assert served(narrow, "127.0.0.2")


def test_while_one_address_holds_all_it_may_busy_a_stop_is_heard_and_nothing_else(narrow: str) -> None:
    """Requests whose bodies are on the way: nobody may end those."""
    head = b"POST /api/maps HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
    with contextlib.ExitStack() as stack:

        def send() -> None:
            sender = stack.enter_context(contextlib.closing(opened(narrow)))
            sender.sendall(head + b"Content-Length: 100\r\n\r\n{")

        def full() -> bool:
            """One whose head was not read yet when the next came was idle and made room: another takes it."""
            if status(narrow, "GET", "/healthz") == 429:
                return True
            send()
            return False

        for _ in range(PER_CLIENT):
            send()
        assert wait_until(full, MUST_END_S)
        for path in ("/api/robots/r1/estop", "/api/robots/r1/estop/"):
            assert status(narrow, "POST", path) == 503, "heard: there is no drive service here"
        assert served(narrow, "127.0.0.2")


def test_a_stop_is_heard_among_1250_connections_that_say_nothing(endpoint: str) -> None:
    for address in serve_gateway(endpoint, header_timeout_s=120.0):
        with contextlib.ExitStack() as stack:
            for number in range(1250):
                sender = stack.enter_context(contextlib.closing(opened(address, f"127.0.0.{2 + number % 5}")))
                sender.sendall(b"POST /api/robots/r1/estop HTTP/1.1\r\nHost:")
            codes = [status(address, "POST", "/api/robots/r1/estop") for _ in range(20)]
            codes.append(status(address, "POST", "/api/robots/r1/estop", "127.0.0.2"))
        assert codes == [503] * 21, "heard: there is no drive service here"


def status(address: str, method: str, path: str, source: str = "127.0.0.1") -> int:
    transport = httpx.HTTPTransport(local_address=source)
    with httpx.Client(transport=transport, timeout=MUST_END_S) as client:
        return client.request(method, address + path).status_code
