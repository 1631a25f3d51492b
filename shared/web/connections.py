"""Connections that end when their sender stalls or may not come in: what uvicorn has no settings for.

A connection must send the head of its next request within a time, whatever trickles in meanwhile; what is
sent to it must be taken; one address has so many connections at most. A WebSocket leaves this when it begins.
"""

import asyncio
import functools
import logging
import socket
import ssl
from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass
from typing import Any, cast

import h11
from uvicorn.protocols.http.h11_impl import H11Protocol

log = logging.getLogger(__name__)

REFUSAL = (
    b"HTTP/1.1 429 Too Many Requests\r\nConnection: close\r\nRetry-After: 5\r\n"
    b"Content-Type: text/plain\r\nContent-Length: 33\r\n\r\ntoo many connections from one IP\n"
)


@dataclass(frozen=True)
class ConnectionLimits:
    """What one connection may do.

    Attributes:
        header_s: to the end of a request's head, from the connection's start or the last answer's end.
        unread_s: how long what was sent may wait for the other side to take it.
        most_per_client: connections of one address.
        unlimited: addresses, for example of a proxy, that have no such limit.
        admitted: common names of certificates, others are not even read; None: whoever connects.
    """

    header_s: float
    unread_s: float
    most_per_client: int
    unlimited: Collection[str] = ()
    admitted: Collection[str] | None = None


class LimitedProtocol(H11Protocol):
    """uvicorn's HTTP/1.1 with `ConnectionLimits`; `opened` counts the connections of each address."""

    def __init__(self, limits: ConnectionLimits, opened: Counter[str], **options: Any) -> None:
        super().__init__(**options)
        self._limits, self._opened = limits, opened
        self._deadline: asyncio.TimerHandle | None = None
        self._counted: str | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Let in who may come in, count the connection and start waiting for its first request."""
        admitted, name = self._limits.admitted, _common_name(transport.get_extra_info("ssl_object"))
        if admitted is not None and name not in admitted:
            log.warning("REST refused to %r: one of %s expected", name, sorted(admitted))
            transport.abort()
            return
        super().connection_made(transport)
        _limit_unread(transport, self._limits.unread_s)
        self._await_head()
        address = self.client[0] if self.client else ""
        if address in self._limits.unlimited:
            return
        if self._opened[address] >= self._limits.most_per_client:
            transport.write(REFUSAL)
            transport.close()
            return
        self._opened[address] += 1
        self._counted = address

    def connection_lost(self, exc: Exception | None) -> None:
        """Forget it; there is nothing to forget of those who never came in."""
        if self.transport is not None:
            self._release()
            super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Pass on what came; a head that is complete has met its deadline."""
        if self.transport is None or self.transport.is_closing():
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
            self._deadline = self.loop.call_later(self._limits.header_s, self._end)

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
            self._opened[self._counted] -= 1
            if not self._opened[self._counted]:
                del self._opened[self._counted]
            self._counted = None


def limited_protocol(limits: ConnectionLimits) -> type[asyncio.Protocol]:
    """What to give uvicorn as `http`."""
    return cast(type[asyncio.Protocol], functools.partial(LimitedProtocol, limits, Counter()))


def _common_name(connection: ssl.SSLObject | None) -> str:
    """Who has shown a certificate, whose chain TLS has checked; "" for nobody."""
    certificate: dict[str, Any] = dict(connection.getpeercert() or {}) if connection is not None else {}
    names = dict(attribute for part in certificate.get("subject", ()) for attribute in part)
    return str(names.get("commonName", ""))


def _limit_unread(transport: asyncio.Transport, unread_s: float) -> None:
    """Have the kernel end connections whose other side does not take what was sent (Linux)."""
    connection = transport.get_extra_info("socket")
    if connection is not None and hasattr(socket, "TCP_USER_TIMEOUT"):
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, int(unread_s * 1000))
