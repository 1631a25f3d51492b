"""What a write to the map costs in a SQLite file and on PostgreSQL, in turns, both waiting for the disk.

Never gating. `pytest -s tests/benchmarks/test_map_store_databases.py`
"""

import statistics
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.messages.features import Features
from shared.messages.maps import AddNode, Edge, Node, Operation, PutEdge
from tests.postgres import PostgresServer, missing

ROUNDS, PLACES, LINKS = 4, 25, 25
KEYPOINTS, THUMBNAIL_BYTES = 300, 10_000
"""A place of the default pipeline."""


def features_of_a_place(rng: np.random.Generator) -> Features:
    """Features of the size that the default pipeline's have."""
    return Features(
        pipeline="sift",
        lonlat_rad=rng.random((KEYPOINTS, 2), dtype=np.float32),
        scores=rng.random(KEYPOINTS, dtype=np.float32),
        descriptors=rng.integers(0, 256, (KEYPOINTS, 128), dtype=np.uint8),
        thumbnail=rng.bytes(THUMBNAIL_BYTES),
    )


def place(number: int) -> list[Operation]:
    """What the planner writes for a new place: it and the edge that leads there."""
    features = features_of_a_place(np.random.default_rng(number))
    added = AddNode(node=Node(node_id=number, pipeline="sift", keypoints=KEYPOINTS), features=features)
    return [added, link(number)] if number else [added]


def link(number: int) -> PutEdge:
    """The edge that leads to a place."""
    return PutEdge(edge=Edge(a=number - 1, b=number, raw_matches=60, inliers=40, heading_ab_rad=0.5))


@pytest.fixture
def urls(tmp_path: Path) -> Iterator[dict[str, str]]:
    """Two databases on the same disk."""
    if why := missing():
        pytest.skip(why)
    server = PostgresServer(durable=True)
    try:
        server.start()
        yield {"sqlite": f"sqlite:///{tmp_path}/maps.sqlite3", "postgresql": server.new_database()}
    finally:
        server.close()


def opened(url: str) -> MapStore:
    return MapStore(Database(url), time.time_ns, lambda _: None)


def timed(store: MapStore, name: str, operations: list[Operation]) -> float:
    """Seconds of one transaction."""
    began_s = time.perf_counter()
    store.transact(name, operations)
    return time.perf_counter() - began_s


def test_cost_of_a_write(urls: dict[str, str], keep: Callable[[dict[str, Any]], None]) -> None:
    stores = {name: opened(url) for name, url in urls.items()}
    took: dict[str, dict[str, list[float]]] = {name: {"place": [], "edge": []} for name in stores}
    for store in stores.values():
        store.create("flat")
    for turn in range(ROUNDS):  # in turns: what else the machine does meets both
        for name, store in stores.items():
            for number in range(turn * PLACES, (turn + 1) * PLACES):
                took[name]["place"].append(timed(store, "flat", place(number)))
            for _ in range(LINKS):
                took[name]["edge"].append(timed(store, "flat", [link(1)]))
    figures = {
        name: {kind: summary(values) for kind, values in kinds.items()} for name, kinds in took.items()
    }
    figures["postgresql"]["two_stores"] = two_writers(urls["postgresql"])
    for store in stores.values():
        store.database.close()
    keep(figures)


def two_writers(url: str) -> dict[str, float]:
    """Two map stores that add places to maps of their own at the same time: places a second of both."""
    stores = [opened(url) for _ in range(2)]
    for number, store in enumerate(stores):
        store.create(f"shared-{number}")

    def work(which: int) -> None:
        for number in range(PLACES):
            stores[which].transact(f"shared-{which}", place(1000 * (which + 1) + number)[:1])

    threads = [threading.Thread(target=work, args=(which,)) for which in range(2)]
    began_s = time.perf_counter()
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    rate = 2 * PLACES / (time.perf_counter() - began_s)
    for store in stores:
        store.database.close()
    return {"per_s": rate}


def summary(values_s: list[float]) -> dict[str, float]:
    return {
        "per_s": len(values_s) / sum(values_s),
        "p50_ms": 1e3 * statistics.median(values_s),
        "p99_ms": 1e3 * statistics.quantiles(values_s, n=100)[98],
    }
