"""Writes to the map store without end: what it acknowledged must be there, whatever happened to it since."""

import threading
import time

import numpy as np

from experiments.soak.journal import Journal
from shared.bus import Bus, open_bus
from shared.messages.features import Features
from shared.messages.maps import AddNode, MapRequest, Node
from shared.queries import QueryError
from shared.topics import MAP
from shared.wire import WireError

PERIOD_S = 1.0  # thousands of writes an hour
CHECK_PERIOD_S = 60.0  # a loss is told within a minute
ANSWER_S = 10.0  # a write takes 3 ms; a store that restarts, seconds
PATIENCE_S = 120.0
"""As long as the launcher may take to bring everything up."""


class Ledger:
    """One node after the other in a map of its own, and the account of those acknowledged."""

    def __init__(self, endpoint: str, journal: Journal) -> None:
        self._endpoint, self._journal = endpoint, journal
        self._map = f"soak-{time.time_ns()}"
        self._acknowledged: set[int] = set()

    def run(self, stop: threading.Event) -> None:
        """Until `stop`, and a last check then."""
        number, checked_s = 0, time.monotonic()
        with open_bus(self._endpoint) as bus:
            while not stop.wait(PERIOD_S):
                self._write(bus, number)
                number += 1
                if time.monotonic() - checked_s > CHECK_PERIOD_S:
                    self._check(bus)
                    checked_s = time.monotonic()
            self._check(bus)

    def _write(self, bus: Bus, number: int) -> None:
        if not self._acknowledged:
            self._try(bus, MapRequest(action="create"))
        if self._try(bus, MapRequest(action="transact", author="soak", operations=(_node(number),))):
            self._acknowledged.add(number)
            self._journal.writes(len(self._acknowledged))

    def _check(self, bus: Bus) -> None:
        """Read everything back; a store that does not answer for long is a violation too."""
        deadline_s = time.monotonic() + PATIENCE_S
        while self._acknowledged and time.monotonic() < deadline_s:
            try:
                found = bus.ask(MAP, MapRequest(action="read"), ANSWER_S, map=self._map)
            except (QueryError, WireError):
                time.sleep(PERIOD_S)
                continue
            lost = sorted(self._acknowledged - {node.node_id for node in found.nodes})
            if lost:
                self._journal.violation("no acknowledged write is lost", f"nodes {lost[:20]} of {self._map}")
                self._acknowledged -= set(lost)
            return
        if self._acknowledged:
            self._journal.violation("the map store answers", f"no answer within {PATIENCE_S} s")

    def _try(self, bus: Bus, request: MapRequest) -> bool:
        try:
            bus.ask(MAP, request, ANSWER_S, map=self._map)
        except (QueryError, WireError):
            return False
        return True


def _node(number: int) -> AddNode:
    rng = np.random.default_rng(number)
    features = Features(
        pipeline="soak",
        lonlat_rad=rng.random((8, 2), dtype=np.float32),
        scores=rng.random(8, dtype=np.float32),
        descriptors=rng.random((8, 16), dtype=np.float32),
    )
    return AddNode(node=Node(node_id=number, pipeline="soak", keypoints=8), features=features)
