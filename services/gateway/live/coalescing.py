"""Emergency stops beyond a rate: those of one robot that come within a moment are sent on as one."""

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, Generic, TypeVar

T = TypeVar("T")

WINDOW_S = 0.05
"""Chosen: no person notices it, and 20 a second are no load to the service that drives."""


class Coalescer(Generic[T]):
    """Every call is followed by one that was sent after it came: none rests on what was true before it.

    Lives in the asyncio thread.
    """

    def __init__(self) -> None:
        self._waiting: dict[str, asyncio.Task[T]] = {}

    async def join(self, key: str, send: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Wait for what is sent next for `key`, by this call or by one that waits already."""
        task = self._waiting.get(key)
        if task is None:
            task = asyncio.create_task(self._send(key, send))
            self._waiting[key] = task
        return await asyncio.shield(task)

    async def _send(self, key: str, send: Callable[[], Coroutine[Any, Any, T]]) -> T:
        await asyncio.sleep(WINDOW_S)
        del self._waiting[key]  # who comes from now on needs one that is sent after this
        return await send()
