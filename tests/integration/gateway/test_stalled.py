"""Senders that stall: timed out, limited in number, and nobody else waits for them."""

import contextlib
import socket
from collections.abc import Iterator

import httpx
import pytest

from shared.bus import wait_until
from tests.integration.gateway.conftest import serve_gateway


@pytest.fixture(scope="module")
def impatient(endpoint: str) -> Iterator[str]:
    """A gateway that waits three seconds for a body and reads two pictures at once."""
    yield from serve_gateway(endpoint, upload_timeout_s=3.0, max_uploads=2)


def stalled(address: str) -> socket.socket:
    host, port = address.removeprefix("http://").split(":")
    sender = socket.create_connection((host, int(port)), timeout=10.0)
    sender.sendall(
        f"POST /api/robots/r1/goal-check?map=flat HTTP/1.1\r\nHost: {host}:{port}\r\n"
        "Content-Type: image/png\r\nContent-Length: 1000\r\n\r\n\x89PNG".encode("latin-1")
    )
    return sender


def test_a_stalled_upload_is_ended(impatient: str) -> None:
    with contextlib.closing(stalled(impatient)) as sender:
        assert b" 408 " in sender.recv(200)


def test_stalled_uploads_hold_few_places_and_block_nothing_else(impatient: str) -> None:
    def free() -> bool:
        answer = httpx.post(
            f"{impatient}/api/robots/r1/goal-check?map=flat",
            headers={"content-type": "image/png"},
            trust_env=False,
        )
        return answer.status_code == 422

    assert wait_until(free, 10.0)
    with contextlib.ExitStack() as stack:
        for _ in range(20):
            stack.enter_context(contextlib.closing(stalled(impatient)))
        assert wait_until(lambda: not free(), 20.0)
        assert httpx.get(f"{impatient}/healthz", trust_env=False, timeout=1.0).status_code == 200
    assert wait_until(free, 10.0)
    assert (
        'uploads_refused_total{reason="too_many_uploads"}'
        in httpx.get(f"{impatient}/metrics", trust_env=False).text
    )
