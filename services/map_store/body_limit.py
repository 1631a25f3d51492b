"""Longest request bodies, refused as a problem; the limit that FastAPI has answers in plain text."""

from collections.abc import Mapping

from fastapi import HTTPException
from starlette.datastructures import Headers
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from services.map_store.problems import problem

TOO_LARGE = 413


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
        seen = 0

        async def counted() -> Message:
            nonlocal seen
            message = await receive()
            seen += len(message.get("body", b""))
            if seen > most:
                raise HTTPException(TOO_LARGE, detail)
            return message

        await self._app(scope, counted, send)
