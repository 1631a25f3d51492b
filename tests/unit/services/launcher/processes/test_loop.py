"""What others see of the services while the thread that looks after them is at work."""

import logging
import threading
from concurrent.futures import ThreadPoolExecutor

import pytest

from services.launcher.processes.loop import SupervisorLoop
from services.launcher.processes.runner import State
from shared.bus import wait_until
from tests.unit.services.launcher.processes.test_runner import Bench

SOON_S = 20.0


@pytest.fixture
def loop():
    """A loop with one service, which is healthy; its process ends when the test says so."""
    bench = Bench()
    loop = SupervisorLoop({"a": bench.runner}, [["a"]], lambda _: None, lambda: None)
    loop.start()
    assert wait_until(lambda: bench.children != [], SOON_S)
    bench.health.alive = frozenset({"t1"})
    assert wait_until(lambda: loop.status()["a"].state is State.HEALTHY, SOON_S)
    loop.bench = bench
    yield loop
    for child in bench.children:
        child.code = 0
    loop.stop()


def test_a_service_that_ends_is_never_seen_healthy_without_a_process(loop):
    """Who waited for the process after a killed one took the moment in between for it."""
    ended, asked = threading.Event(), []
    with ThreadPoolExecutor(1) as elsewhere:

        class Between(logging.Handler):
            def emit(self, record):
                if not asked and "ended with" in record.getMessage():
                    asked.append(elsewhere.submit(loop.status))
                    ended.set()
                    threading.Event().wait(0.2)  # so that the other thread could answer

        log = logging.getLogger("services.launcher.processes.runner")
        handler = Between()
        log.addHandler(handler)
        try:
            loop.bench.children[0].code = -9
            assert ended.wait(SOON_S)
            seen = asked[0].result(SOON_S)["a"]
        finally:
            log.removeHandler(handler)
    assert (seen.state is State.HEALTHY) <= (seen.pid is not None)
