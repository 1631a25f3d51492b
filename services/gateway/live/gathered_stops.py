"""Emergency stops beyond a rate: those of one robot that come within a moment are passed on as one."""

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any, Generic, TypeVar

T = TypeVar("T")

GATHER_S = 0.05


class GatheredStops(Generic[T]):
    """Every stop is followed by one that was sent after it came: none rests on what was true before it.

    Lives in the asyncio thread.
    """

    def __init__(self) -> None:
        self._gathering: dict[str, asyncio.Task[T]] = {}

    async def join(self, robot: str, send: Callable[[], Coroutine[Any, Any, T]]) -> T:
        """Wait for the stop that is sent next for the robot, here or by who gathers already."""
        task = self._gathering.get(robot)
        if task is None:
            task = asyncio.create_task(self._send(robot, send))
            self._gathering[robot] = task
        return await asyncio.shield(task)

    async def _send(self, robot: str, send: Callable[[], Coroutine[Any, Any, T]]) -> T:
        await asyncio.sleep(GATHER_S)
        del self._gathering[robot]  # who comes from now on needs one that is sent after this
        return await send()
