"""Bodies of requests while they arrive: how long they may be and how slow."""

import asyncio
import math
import time
from collections.abc import Mapping
from dataclasses import dataclass

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from shared.web.problems import ProblemError

DRAIN_BYTES = 64_000_000
"""How much of a refused body is still read, so that the sender sees the answer and not a broken pipe:
a little more than the longest picture that settings allow."""


@dataclass(frozen=True)
class BodyLimit:
    """What one body may take.

    Attributes:
        most_bytes: its length.
        stalled_s: how long any part of it may take.
        bytes_per_s: least rate; the whole body must come within `stalled_s` and its length at this rate.
        next_step: what somebody can do who sent too much.
    """

    most_bytes: int
    stalled_s: float
    bytes_per_s: float = math.inf
    next_step: str = "send less, for example a smaller picture"


def limited(receive: Receive, limit: BodyLimit) -> Receive:
    """The same as `receive`, which raises ProblemError 413 and 408 for a body beyond `limit`."""
    length, began_s, more = 0, time.monotonic(), True

    async def next_part() -> Message:
        nonlocal length, more
        since_s = time.monotonic() - began_s
        left_s = limit.stalled_s + min(0.0, length / limit.bytes_per_s - since_s)
        try:
            async with asyncio.timeout(left_s if more else None):
                message = await receive()
        except TimeoutError:
            raise _too_slow(limit, f"{length} bytes in {time.monotonic() - began_s:.0f} s") from None
        length, more = length + len(message.get("body", b"")), message.get("more_body", False)
        return message

    async def receive_limited() -> Message:
        message = await next_part()
        while more and limit.most_bytes < length <= limit.most_bytes + DRAIN_BYTES:
            await next_part()
        if length > limit.most_bytes:
            expected, got = f"at most {limit.most_bytes} bytes", f"at least {length} bytes"
            raise ProblemError(413, "body_too_large", expected, got, limit.next_step)
        return message

    return receive_limited


class BodyLimits:
    """ASGI middleware: `most` for every request but those to the paths in `exceptions`."""

    def __init__(self, app: ASGIApp, most: BodyLimit, exceptions: Mapping[str, BodyLimit]) -> None:
        self._app, self._most, self._exceptions = app, most, exceptions

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on with a body that keeps to its limit."""
        if scope["type"] == "http":
            receive = limited(receive, self._exceptions.get(scope["path"], self._most))
        await self._app(scope, receive, send)


def _too_slow(limit: BodyLimit, got: str) -> ProblemError:
    expected = f"the whole body within {limit.stalled_s:g} s"
    if math.isfinite(limit.bytes_per_s):
        expected = f"a part every {limit.stalled_s:g} s and {limit.bytes_per_s:g} bytes a second"
    return ProblemError(408, "body_too_slow", expected, got, "send it faster or smaller")
