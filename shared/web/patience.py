"""Connections that end when their sender stalls: what uvicorn has no time-outs for.

A connection must send the head of its next request within a time, whatever trickles in meanwhile; what is
sent to it must be taken; one address has so many connections at most. A WebSocket leaves this when it begins.
"""

import asyncio
import socket
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any, cast

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

REFUSAL = (
    b"HTTP/1.1 429 Too Many Requests\r\nConnection: close\r\nRetry-After: 5\r\n"
    b"Content-Type: text/plain\r\nContent-Length: 33\r\n\r\ntoo many connections from one IP\n"
)


@dataclass(frozen=True)
class Patience:
    """How much is borne.

    Attributes:
        header_s: to the end of a request's head, from the connection's start or the last answer's end.
        unread_s: how long what was sent may wait for the other side to take it.
        most_per_client: connections of one address.
        unlimited: addresses, for example of a proxy, that have no such limit.
    """

    header_s: float
    unread_s: float
    most_per_client: int
    unlimited: Collection[str] = ()
    open: Counter[str] = field(default_factory=Counter)


class PatientProtocol(H11Protocol):
    """uvicorn's HTTP/1.1 with the limits of a `Patience`."""

    def __init__(self, patience: Patience, **options: Any) -> None:
        super().__init__(**options)
        self._patience = patience
        self._deadline: asyncio.TimerHandle | None = None
        self._counted: str | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Count the connection and start waiting for its first request."""
        super().connection_made(transport)
        _limit_unread(transport, self._patience.unread_s)
        self._await_head()
        address = self.client[0] if self.client else ""
        if address in self._patience.unlimited:
            return
        if self._patience.open[address] >= self._patience.most_per_client:
            transport.write(REFUSAL)
            transport.close()
            return
        self._patience.open[address] += 1
        self._counted = address

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget it."""
        self._release()
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Pass on what came; a head that is complete has met its deadline."""
        if self.transport.is_closing():
            return
        super().data_received(data)
        if self.cycle is not None and not self.cycle.response_complete:
            self._stop_waiting()

    def handle_websocket_upgrade(self, event: h11.Request) -> None:
        """From here on the WebSocket's own limits hold."""
        self._release()
        super().handle_websocket_upgrade(event)

    def on_response_complete(self) -> None:
        """Wait for the next request: what is left of this one's body does not prolong it."""
        super().on_response_complete()
        if not self.transport.is_closing() and (self.cycle is None or self.cycle.response_complete):
            self._await_head()

    def _await_head(self) -> None:
        if self._deadline is None:
            self._deadline = self.loop.call_later(self._patience.header_s, self._end)

    def _stop_waiting(self) -> None:
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _end(self) -> None:
        self._deadline = None
        self.transport.abort()

    def _release(self) -> None:
        self._stop_waiting()
        if self._counted is not None:
            self._patience.open[self._counted] -= 1
            if not self._patience.open[self._counted]:
                del self._patience.open[self._counted]
            self._counted = None


def patient_protocol(patience: Patience) -> type[asyncio.Protocol]:
    """What to give uvicorn as `http`."""

    class Protocol(PatientProtocol):
        def __init__(self, **options: Any) -> None:
            super().__init__(patience, **options)

    return cast(type[asyncio.Protocol], Protocol)


def _limit_unread(transport: asyncio.Transport, unread_s: float) -> None:
    """Have the kernel end connections whose other side does not take what was sent (Linux)."""
    connection = transport.get_extra_info("socket")
    if connection is not None and hasattr(socket, "TCP_USER_TIMEOUT"):
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, int(unread_s * 1000))
