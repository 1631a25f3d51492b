"""The WebSocket: news, origin, limits, and readers that do not read."""

import contextlib
import json
import socket
import time
from collections.abc import Iterator

import httpx
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from shared.bus import Bus, Publisher, wait_until
from shared.messages.drive import Heading
from shared.messages.missions import Event
from shared.topics import EVENT, HEADING
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.gateway.gateway_process import WAIT_S

ROBOT = "w1"
SOCKETS, SOON_S = 3, 1.0
FIRST_BYTES = {"texts": 0x81, "continuations": 0x00, "pings": 0x89}
"""Of frames: the final bit and the opcode (RFC 6455, 5.2)."""
HALF_TEXT = bytes([0x01, 0x80, 0, 0, 0, 0])
DROPPED_S = 90.0
"""So long until a deaf reader is dropped, on a machine that forgets about us now and then."""


def url(address: str, robot: str = ROBOT) -> str:
    return f"{address.replace('http', 'ws', 1)}/api/robots/{robot}/live"


def opened(address: str, **options: object) -> ClientConnection:
    return connect(url(address), proxy=None, open_timeout=WAIT_S, **options)  # type: ignore[arg-type]


@pytest.fixture(scope="module")
def small(endpoint: str) -> Iterator[str]:
    """A gateway with room for three connections."""
    yield from serve_gateway(endpoint, max_sockets=3, send_timeout_s=1.0)


def next_of(live: ClientConnection, kind: str) -> dict[str, object]:
    deadline_s = time.monotonic() + WAIT_S
    while time.monotonic() < deadline_s:
        message = json.loads(live.recv(timeout=WAIT_S))
        if message["type"] == kind:
            return dict(message["data"])
    raise AssertionError(f"no {kind}")


def read_up_to(live: ClientConnection, events: Publisher[Event], last: Event) -> None:
    """Say this event and read until it comes; say it again meanwhile: under load the bus drops some."""
    deadline_s = time.monotonic() + WAIT_S
    events.put(last)
    while time.monotonic() < deadline_s:
        try:
            message = json.loads(live.recv(timeout=1.0))
        except TimeoutError:
            events.put(last)
            continue
        if message["type"] == "event" and message["data"]["seq"] == last.seq:
            return
    raise AssertionError(f"no event {last.seq}")


def metrics(address: str) -> str:
    return httpx.get(f"{address}/metrics", trust_env=False, timeout=WAIT_S).text


def test_decisions_and_headings_arrive(small: str, robot_bus: Bus) -> None:
    events, headings = robot_bus.publisher(EVENT, robot=ROBOT), robot_bus.publisher(HEADING, robot=ROBOT)
    with opened(small) as live:
        assert next_of(live, "services")

        def known() -> bool:  # what was said before the gateway's subscription reached us is not heard
            events.put(Event(seq=1, robot=ROBOT, kind="replan", reason="lost: S 31"))
            path = f"/api/robots/{ROBOT}/events"
            return httpx.get(f"{small}{path}", trust_env=False, timeout=WAIT_S).status_code == 200

        assert wait_until(known, WAIT_S)
        assert next_of(live, "event")["reason"] == "lost: S 31"

        def heard() -> bool:  # the event made the robot known; its heading is followed from then on
            headings.put(Heading(seq=9, robot=ROBOT, heading_rad=0.25))
            view = httpx.get(f"{small}/api/robots/{ROBOT}", trust_env=False, timeout=WAIT_S).json()
            return view["heading"] is not None

        assert wait_until(heard, WAIT_S)
        assert next_of(live, "heading")["heading_rad"] == 0.25


@pytest.mark.parametrize("origin", ["http://evil.example", "null"])
def test_pages_of_other_sites_are_refused(small: str, origin: str) -> None:
    with pytest.raises(InvalidStatus) as caught:
        opened(small, origin=origin)
    assert caught.value.response.status_code == 403
    assert json.loads(caught.value.response.body)["title"] == "foreign origin"


def test_the_gateways_own_page_is_welcome(small: str) -> None:
    with opened(small, origin=small) as live:
        assert next_of(live, "services") is not None


@pytest.mark.parametrize("robot", ["A", "..%5cx", "%00", "a%0a", "x" * 65, "missions"])
def test_bad_names_are_refused(small: str, robot: str) -> None:
    with pytest.raises(InvalidStatus) as caught:
        connect(url(small, robot), proxy=None, open_timeout=WAIT_S)
    assert caught.value.response.status_code in (403, 404, 422)


def test_connections_are_limited_and_freed(small: str) -> None:
    def room() -> bool:
        try:
            with opened(small) as live:
                live.recv(timeout=WAIT_S)
                return True
        except ConnectionClosed:
            return False

    assert wait_until(lambda: "topnav_gateway_sockets 0.0" in metrics(small), WAIT_S)
    with opened(small) as one, opened(small) as two, opened(small) as three:
        for live in (one, two, three):
            live.recv(timeout=WAIT_S)
        with opened(small) as fourth, pytest.raises(ConnectionClosed) as caught:
            fourth.recv(timeout=WAIT_S)
        assert caught.value.rcvd is not None
        assert (caught.value.rcvd.code, caught.value.rcvd.reason) == (1013, "too_many_sockets")
    assert wait_until(room, WAIT_S)


def test_a_reader_that_stops_reading_is_dropped_and_blocks_nobody(small: str, robot_bus: Bus) -> None:
    events = robot_bus.publisher(EVENT, robot=ROBOT)
    host, port = small.removeprefix("http://").split(":")
    deaf = socket.create_connection((host, int(port)))
    deaf.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    deaf.sendall(
        f"GET /api/robots/{ROBOT}/live HTTP/1.1\r\nHost: {host}:{port}\r\nUpgrade: websocket\r\n"
        "Connection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        "Sec-WebSocket-Version: 13\r\n\r\n".encode()
    )
    try:
        with opened(small, max_queue=None) as live:
            sent = 0

            def dropped() -> bool:
                nonlocal sent
                for _ in range(400):
                    events.put(Event(seq=sent, robot=ROBOT, kind="load", reason="x" * 400))
                    sent += 1
                # This reader keeps up: only the other is slow.
                read_up_to(live, events, Event(seq=sent, robot=ROBOT, kind="load"))
                sent += 1
                return "sockets_dropped_total{" in metrics(small)

            assert wait_until(dropped, DROPPED_S)
            read_up_to(live, events, Event(seq=10**6, robot=ROBOT, kind="after"))
    finally:
        deaf.close()


@pytest.mark.parametrize("kind", FIRST_BYTES)
def test_a_flood_of_tiny_frames_ends_its_connections_and_holds_up_nobody(small: str, kind: str) -> None:
    tiny = bytes([FIRST_BYTES[kind], 0x80, 0, 0, 0, 0]) * 80_000  # masked, as a client's must be, and empty
    with contextlib.ExitStack() as stack:
        floods = [stack.enter_context(opened(small)) for _ in range(SOCKETS)]
        for flood in floods:
            flood.socket.settimeout(SOON_S)
            with contextlib.suppress(TimeoutError, ConnectionError):
                flood.socket.sendall((HALF_TEXT if kind == "continuations" else b"") + tiny)
        began_s = time.monotonic()
        assert httpx.get(f"{small}/healthz", timeout=WAIT_S).status_code == 200
        assert time.monotonic() - began_s < SOON_S
        for flood in floods:
            with pytest.raises(ConnectionClosed):
                next_of(flood, "nothing of this kind")


def test_pings_and_pongs_of_a_patient_reader_are_welcome(small: str) -> None:
    with connect(url(small, "quiet"), proxy=None, open_timeout=WAIT_S) as live:
        for _ in range(20):
            assert live.ping().wait(WAIT_S)


def test_long_messages_of_a_reader_end_its_connection(small: str) -> None:
    def talk() -> None:
        live.send("x" * 100_000)
        next_of(live, "nothing of this kind")

    with opened(small) as live, pytest.raises(ConnectionClosed):
        talk()
