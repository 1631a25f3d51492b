"""How long a feature service that joins late takes to know 10,000 places; says figures, gates nothing.

pytest -q -s tests/benchmarks/test_late_feature_service.py
"""

import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import zenoh

from services.features.service import run
from services.features.settings import FeaturesSettings
from shared.bus import Bus, open_bus, wait_until
from shared.messages.features import Features
from shared.messages.maps import AddNode, MapRequest, Node
from shared.messages.matching import MatchRequest
from shared.topics import MAP, MATCH
from shared.transport.router_config import router_config
from tests.integration.gateway.conftest import free_port
from tests.integration.map_store.conftest import START_S, Process

pytestmark = [pytest.mark.slow, pytest.mark.timeout(600)]

PLACES, PIECE, WORDS = 10_000, 200, 300
PATIENCE_S = 300.0


@pytest.fixture
def bus(repository: Path, tmp_path: Path) -> Iterator[Bus]:
    """A session beside a router and a map store with a map of so many places."""
    endpoint = f"tcp/127.0.0.1:{free_port()}"
    router = zenoh.open(router_config(endpoint))
    store = Process(repository, tmp_path, endpoint, free_port())
    store.start()
    try:
        with open_bus(endpoint) as mine:
            assert wait_until(lambda: mine.alive("map_store") != [], START_S)
            fill(mine)
            stop = threading.Event()
            late = threading.Thread(target=serve, args=(endpoint, stop))
            late.start()
            yield mine
            stop.set()
            late.join()
    finally:
        store.kill()
        router.close()  # type: ignore[no-untyped-call]


def place(number: int) -> Features:
    """Words that only this place has."""
    rng = np.random.default_rng(number)
    lonlat = np.stack([rng.uniform(-np.pi, np.pi, WORDS), rng.uniform(-1, 1, WORDS)], axis=1)
    return Features(
        pipeline=FeaturesSettings().profile().identity,
        lonlat_rad=lonlat.astype(np.float32),
        scores=np.ones(WORDS, np.float32),
        descriptors=rng.integers(0, 120, (WORDS, 128)).astype(np.uint8),
    )


def fill(bus: Bus) -> None:
    bus.ask(MAP, MapRequest(action="create"), 10.0, map="big")
    for start in range(0, PLACES, PIECE):
        added = [AddNode(node=Node(node_id=n), features=place(n)) for n in range(start, start + PIECE)]
        bus.ask(MAP, MapRequest(action="transact", operations=tuple(added)), PATIENCE_S, map="big")


def serve(endpoint: str, stop: threading.Event) -> None:
    with open_bus(endpoint) as mine:
        run(FeaturesSettings(endpoint=endpoint), mine, stop)


def test_a_late_service_knows_a_large_map_in_seconds(
    bus: Bus, keep: Callable[[dict[str, Any]], None]
) -> None:
    assert wait_until(lambda: bus.alive("features") != [], START_S)
    question = MatchRequest(map="big", features=place(4321), best_k=1, with_matches=False)
    times_s = []
    for _ in range(3):
        start_s = time.perf_counter()
        reply = bus.ask(MATCH, question, PATIENCE_S, robot="r1")
        times_s.append(time.perf_counter() - start_s)
        assert [match.node_id for match in reply.results] == [4321]
    keep({"places": PLACES, "first_answer_s": times_s[0], "then_ms": 1e3 * times_s[-1]})
