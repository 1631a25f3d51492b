"""Connections that end when their sender stalls or may not come in: what uvicorn has no settings for.

A connection must send the head of its next request within a time, whatever trickles in meanwhile; what is
sent to it must be taken; there are so many connections at most. A WebSocket leaves this when it begins.
"""

import asyncio
import functools
import logging
import re
import socket
import ssl
from typing import Any, cast

import h11
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

from shared.web.crowding import Admission, ConnectionLimits, Crowd

log = logging.getLogger(__name__)

TOO_MANY = "too many connections: close some, or wait until they are\n"
CLOSING = {"Connection": "close", "Retry-After": "5"}
REFUSAL = (
    f"HTTP/1.1 429 Too Many Requests\r\nConnection: close\r\nRetry-After: 5\r\n"
    f"Content-Type: text/plain\r\nContent-Length: {len(TOO_MANY)}\r\n\r\n{TOO_MANY}"
).encode()


class LimitedProtocol(H11Protocol):
    """uvicorn's HTTP/1.1 with `ConnectionLimits`, among the `crowd` of a server's connections."""

    def __init__(self, limits: ConnectionLimits, crowd: Crowd, **options: Any) -> None:
        super().__init__(**options)
        self._limits, self._crowd = limits, crowd
        self._deadline: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Let in who may come in, count the connection and start waiting for its first request."""
        admitted, name = self._limits.admitted, _common_name(transport.get_extra_info("ssl_object"))
        if admitted is not None and name not in admitted:
            log.warning("REST refused to %r: one of %s expected", name, sorted(admitted))
            transport.abort()
            return
        super().connection_made(transport)
        _limit_unread(transport, self._limits.unread_s)
        admission = self._crowd.admit(self, self.client[0] if self.client else "")
        if admission is Admission.REFUSED:
            transport.write(REFUSAL)
            transport.close()
            return
        if admission is Admission.RESERVED and self._limits.always is not None:
            self.app = _only(self._limits.always, self.app)
        self._await_head()

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

    def evict(self) -> None:
        """Make room for another."""
        self._end()

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
        self._crowd.waits(self)
        if self._deadline is None:
            self._deadline = self.loop.call_later(self._limits.header_s, self._end)

    def _stop_waiting(self) -> None:
        self._crowd.works(self)
        if self._deadline is not None:
            self._deadline.cancel()
            self._deadline = None

    def _end(self) -> None:
        self._deadline = None
        self.transport.abort()

    def _release(self) -> None:
        self._stop_waiting()
        self._crowd.forget(self)


def limited_protocol(limits: ConnectionLimits) -> type[asyncio.Protocol]:
    """What to give uvicorn as `http`."""
    return cast(type[asyncio.Protocol], functools.partial(LimitedProtocol, limits, Crowd(limits)))


def _only(always: re.Pattern[str], app: ASGIApp) -> ASGIApp:
    """The application for requests to some paths; others are refused."""

    async def serve(scope: Scope, receive: Receive, send: Send) -> None:
        allowed = scope["type"] == "http" and always.fullmatch(scope["path"]) is not None
        answer = app if allowed else PlainTextResponse(TOO_MANY, 429, CLOSING)
        await answer(scope, receive, send)

    return serve


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
