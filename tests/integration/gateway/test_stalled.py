"""Senders that stall: timed out, limited in number, and nobody else waits for them."""

import contextlib
import socket
from collections.abc import Iterator

import httpx
import pytest

from shared.bus import wait_until
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S, answers

LONG_S = 4 * WAIT_S


@pytest.fixture(scope="module")
def impatient(endpoint: str) -> Iterator[str]:
    """A gateway that waits a second for a body."""
    yield from serve_gateway(endpoint, upload_timeout_s=1.0)


@pytest.fixture(scope="module")
def narrow(endpoint: str) -> Iterator[str]:
    """A gateway that reads two pictures at once and waits for them longer than the test lasts."""
    yield from serve_gateway(endpoint, upload_timeout_s=LONG_S, max_uploads=2)


def stalled(address: str) -> socket.socket:
    host, port = address.removeprefix("http://").split(":")
    sender = socket.create_connection((host, int(port)), timeout=WAIT_S)
    sender.sendall(
        f"POST /api/robots/r1/goal-check?map=flat HTTP/1.1\r\nHost: {host}:{port}\r\n"
        "Content-Type: image/png\r\nContent-Length: 1000\r\n\r\n\x89PNG".encode("latin-1")
    )
    return sender


def test_a_stalled_upload_is_ended(impatient: str) -> None:
    with contextlib.closing(stalled(impatient)) as sender:
        assert b" 408 " in sender.recv(200)


def test_stalled_uploads_hold_few_places_and_block_nothing_else(narrow: str) -> None:
    def free() -> bool:
        answer = httpx.post(
            f"{narrow}/api/robots/r1/goal-check?map=flat",
            headers={"content-type": "image/png"},
            trust_env=False,
            timeout=WAIT_S,
        )
        return answer.status_code == 422

    assert wait_until(free, WAIT_S)
    with contextlib.ExitStack() as stack:
        for _ in range(20):
            stack.enter_context(contextlib.closing(stalled(narrow)))
        assert wait_until(lambda: not free(), WAIT_S)
        assert answers(narrow)  # much sooner than the stalled ones are ended
    assert wait_until(free, WAIT_S)
    metrics = httpx.get(f"{narrow}/metrics", trust_env=False, timeout=WAIT_S).text
    assert 'uploads_refused_total{reason="too_many_uploads"}' in metrics
