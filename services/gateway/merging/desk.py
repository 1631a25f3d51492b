"""Merges of one gateway: one at a time, and how the last ones ended."""

import asyncio
import logging

from services.gateway.merging.job import Merge, MergeAnswer
from services.gateway.merging.reading import ReadMap
from services.gateway.state import Gateway
from shared.web.problems import ProblemError

log = logging.getLogger(__name__)

KEPT = 32
"""Maps whose last merge is remembered."""


class MergeDesk:
    """Starts merges in the background. Lives in the asyncio thread."""

    def __init__(self, gateway: Gateway) -> None:
        self._gateway = gateway
        self._merges: dict[str, Merge] = {}
        self._running: tuple[Merge, asyncio.Task[None]] | None = None

    def start(self, base: ReadMap, other: ReadMap, author: str) -> MergeAnswer:
        """Begin to add `other` to `base`; `author` stands in the history.

        Raises:
            ProblemError: 409, one is running.
        """
        if self._running is not None:
            merge, _ = self._running
            raise ProblemError(
                409,
                "merge_running",
                expected="no other merge at the same time",
                got=f"{merge.answer.other} is being merged into {merge.answer.map}",
                next_step="wait for it or cancel it",
            )
        merge = Merge(self._gateway, base, other, author)
        task = asyncio.create_task(merge.run())
        self._running = merge, task
        task.add_done_callback(self._ended)
        self._merges.pop(base.name, None)
        self._merges[base.name] = merge
        while len(self._merges) > KEPT:
            del self._merges[next(iter(self._merges))]
        return merge.answer

    def look(self, map_name: str) -> MergeAnswer:
        """The running or last merge into a map.

        Raises:
            ProblemError: 404, there was none.
        """
        return self._find(map_name).answer

    async def cancel(self, map_name: str) -> MergeAnswer:
        """Stop the running merge into a map; one that has ended stays as it is.

        Raises:
            ProblemError: 404 there was none, 409 it is being written.
        """
        merge = self._find(map_name)
        if merge.answer.state == "writing":
            raise ProblemError(
                409,
                "merge_writing",
                expected="a merge that is still matching",
                got="one that is being written",
                next_step="undo it when it is done",
            )
        if self._running is not None and self._running[0] is merge:
            await self._stop(self._running[1])
        return merge.answer

    async def close(self) -> None:
        """Stop what is running."""
        if self._running is not None:
            await self._stop(self._running[1])

    def _find(self, map_name: str) -> Merge:
        if map_name not in self._merges:
            raise ProblemError(
                404,
                "no_merge",
                expected="a map that another was merged into",
                got=f"no merge into {map_name} since the gateway started",
                next_step=f"start one with POST /api/maps/{map_name}/merge",
            )
        return self._merges[map_name]

    def _ended(self, task: asyncio.Task[None]) -> None:
        if self._running is None or self._running[1] is not task:
            return
        merge, self._running = self._running[0], None
        if task.cancelled():
            merge.stop()
        elif (error := task.exception()) is not None:
            log.error("merge into %s failed", merge.answer.map, exc_info=error)
            merge.fail()

    @staticmethod
    async def _stop(task: asyncio.Task[None]) -> None:
        task.cancel()
        await asyncio.wait([task])
