"""Longest request bodies, and how long they may stall; the limit that FastAPI has answers in plain text."""

import asyncio
from collections.abc import Mapping

from fastapi import HTTPException
from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from services.map_store.api.problems import problem

TOO_SLOW, TOO_LARGE = 408, 413
STALLED_S = 30.0
"""The gateway ends stalled senders earlier; this is for those that come here directly."""


class BodyLimit:
    """ASGI middleware.

    Args:
        app: what it guards.
        most: longest body in bytes.
        exceptions: path -> longest body of requests to it.
    """

    def __init__(self, app: ASGIApp, most: int, exceptions: Mapping[str, int]) -> None:
        self._app, self._most, self._exceptions = app, most, exceptions

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer 413 at once when the announced length is too long, else count what comes."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        most = self._exceptions.get(scope["path"], self._most)
        detail = f"a body of at most {most} bytes is expected"
        announced = Headers(scope=scope).get("content-length", "0")
        if announced.isascii() and announced.isdigit() and int(announced[:20]) > most:
            await problem("content-too-large", TOO_LARGE, detail)(scope, receive, send)
            return
        seen, more = 0, True

        async def counted() -> Message:
            nonlocal seen, more
            try:
                async with asyncio.timeout(STALLED_S if more else None):
                    message = await receive()
            except TimeoutError:
                raise HTTPException(TOO_SLOW, f"the next part of the body within {STALLED_S:g} s") from None
            seen, more = seen + len(message.get("body", b"")), message.get("more_body", False)
            if seen > most:
                raise HTTPException(TOO_LARGE, detail)
            return message

        await self._app(scope, counted, send)
