"""Waiting for what cannot wake anybody."""

import time
from collections.abc import Callable


def wait_until(condition: Callable[[], bool], timeout_s: float, period_s: float = 0.02) -> bool:
    """Poll `condition` until it holds or `timeout_s` passes; returns whether it held."""
    deadline_s = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline_s:
            return False
        time.sleep(period_s)
    return True
