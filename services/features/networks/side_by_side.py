"""Work shared out among threads that compute each by itself.

The threads that torch shares a product out among wait for each other at its end, and a small network is
hundreds of small products. Whole pictures shared out among as many threads of one core each wait once.
"""

import itertools
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

import torch

Item = TypeVar("Item")
Result = TypeVar("Result")


class SideBySide:
    """As many threads as torch may use when this is made, each of one core.

    Args:
        device: where the work runs; one other than a CPU gets all of it at once.
    """

    def __init__(self, device: torch.device) -> None:
        self.count = torch.get_num_threads() if device.type == "cpu" else 1
        self._threads: ThreadPoolExecutor | None = None

    def map(self, work: Callable[[Sequence[Item]], list[Result]], items: Sequence[Item]) -> list[Result]:
        """One result for each item, in their order; items side by side in a sequence are worked on together.

        Args:
            work: for the items of one part; it is called by several threads at once.
            items: they are parted evenly.
        """
        parts = min(self.count, len(items))
        if parts <= 1:
            return work(items)
        bounds = [len(items) * part // parts for part in range(parts + 1)]
        shares = [items[begin:end] for begin, end in itertools.pairwise(bounds)]
        return [result for share in self._started().map(work, shares) for result in share]

    def _started(self) -> ThreadPoolExecutor:
        """The threads, each told to use one core; what torch's other users have is as it was."""
        if self._threads is None:
            self._threads = ThreadPoolExecutor(self.count, "side-by-side", _use_one_core)
            all_there = threading.Barrier(self.count)
            list(self._threads.map(lambda _: all_there.wait(), range(self.count)))
            torch.set_num_threads(self.count)
        return self._threads


def _use_one_core() -> None:
    """For this thread alone, which is asked once: who never asked gets the number that somebody sets next."""
    torch.set_num_threads(1)
    torch.get_num_threads()
