"""Peak memory of a call, traced in a process that has no thread but Python's own.

CPython 3.11 may crash when tracing stops while a thread that Python did not start allocates (gh-128679), and
Zenoh's do, in every test process that has opened a session.
"""

import tracemalloc
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from typing import Any

TracedCall = Callable[..., tuple[Any, int]]
"""Takes a function of a module and its arguments; what it returned, and its peak of memory in bytes."""


@contextmanager
def tracing_process() -> Iterator[TracedCall]:
    """A process that makes calls, one after the other; an error of a call is raised here."""
    with ProcessPoolExecutor(max_workers=1, mp_context=get_context("spawn")) as process:
        yield lambda function, *args: process.submit(_traced, function, *args).result()


def _traced(function: Callable[..., Any], *args: Any) -> tuple[Any, int]:
    tracemalloc.start()
    try:
        result = function(*args)
        return result, tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
