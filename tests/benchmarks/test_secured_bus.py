"""What mTLS and access rules cost: question and answer, and the way of a picture, open and secured, in turns.

Never gating. `pytest -s tests/benchmarks/test_secured_bus.py`
"""

import datetime as dt
import os
import statistics
import subprocess
import sys
import threading
import time
from contextlib import ExitStack

import pytest

from services.launcher.processes.free_ports import free_ports
from shared.bus import open_bus, wait_until
from shared.certificates.holders import everyone
from shared.certificates.issuing import make
from shared.messages.estop import EStopRequest, EStopState
from shared.topics import ESTOP, FRAME

ROUNDS, ASKS, PICTURES = 5, 100, 20
PICTURE = bytes(400_000)
"""About a camera frame of 1024 x 512 as JPEG."""


class Link:
    """Gateway and simulator on one router: drive answers the gateway, which also watches the pictures."""

    def __init__(self, stack, endpoint, certs):
        def join(holder):
            return stack.enter_context(open_bus(endpoint, certs=certs / holder if certs else None))

        self._asker, answerer, camera = join("gateway"), join("drive"), join("simulator")
        self._requests = answerer.requests(ESTOP, robot="r1")
        self._frames, self._arrived = camera.publisher(FRAME, robot="r1"), threading.Event()
        self._asker.tap(FRAME, lambda *_: self._arrived.set())
        self._stop = threading.Event()
        thread = threading.Thread(target=self._answer, args=(answerer,))
        thread.start()
        stack.callback(thread.join)
        stack.callback(self._stop.set)
        assert wait_until(lambda: self._picture() is not None, 30.0)

    def asks_ms(self):
        return [self._timed(lambda: self._asker.ask(ESTOP, EStopRequest(action="status"), 5.0, robot="r1"))
                for _ in range(ASKS)]  # fmt: skip

    def pictures_ms(self):
        return [ms for _ in range(PICTURES) if (ms := self._picture()) is not None]

    def _picture(self):
        self._arrived.clear()
        began_s = time.perf_counter()
        self._frames.put_bytes(PICTURE)
        return 1e3 * (time.perf_counter() - began_s) if self._arrived.wait(1.0) else None

    def _timed(self, act):
        began_s = time.perf_counter()
        act()
        return 1e3 * (time.perf_counter() - began_s)

    def _answer(self, bus):
        while not self._stop.is_set():
            bus.wait(0.1)
            while (request := self._requests.take()) is not None:
                request.reply(EStopState(robot="r1", engaged=False))


@pytest.fixture
def links(tmp_path, repository):
    """Name of the profile -> link: peers that talk directly, and clients of a secured router."""
    certs = tmp_path / "certs"
    make(certs, everyone("r1"), dt.datetime.now(dt.UTC))
    ports = free_ports(2)
    with ExitStack() as stack:
        routers = {
            "open": (f"tcp/127.0.0.1:{ports[0]}", None),
            "secured": (f"tls/127.0.0.1:{ports[1]}", certs),
        }
        for endpoint, folder in routers.values():
            variables = {
                "TOPNAV_ROUTER_LISTEN": endpoint,
                "TOPNAV_CERTS": str(folder / "router") if folder else "",
            }
            child = subprocess.Popen(
                [sys.executable, "-m", "shared.router"], cwd=repository, env=os.environ | variables
            )
            stack.callback(child.wait)
            stack.callback(child.kill)
        yield {name: Link(stack, *where) for name, where in routers.items()}


def test_cost_of_the_secured_bus(links, keep):
    asks, pictures = {name: [] for name in links}, {name: [] for name in links}
    for _ in range(ROUNDS):  # in turns: what else the machine does meets both
        for name, link in links.items():
            asks[name] += link.asks_ms()
            pictures[name] += link.pictures_ms()
    figures = {}
    for what, times in (("question and answer", asks), (f"{len(PICTURE) / 1e3:.0f} kB picture", pictures)):
        median = {name: statistics.median(values) for name, values in times.items()}
        tail = {name: statistics.quantiles(values, n=100)[98] for name, values in times.items()}
        figures[what] = {"p50_ms": median, "p99_ms": tail, "ratio": median["secured"] / median["open"]}
        assert all(values for values in times.values())
    keep(figures)
