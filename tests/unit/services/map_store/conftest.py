"""A store in a fresh database with a clock that ticks, and what it told its followers."""

from collections.abc import Iterator
from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from services.map_store.api.app import create_app
from services.map_store.inspections.store import InspectionStore
from services.map_store.merging.merges import Merges
from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.messages.features import Features
from shared.messages.maps import AddNode, Edge, MapDelta, Node, PutEdge
from shared.messages.matching import MatchReply, MatchRequest
from shared.queries import AbsentError

Told = list[MapDelta]


def features(number: int, thumbnail: bool = True) -> Features:
    """Small features that differ by `number`."""
    rng = np.random.default_rng(number)
    return Features(
        pipeline="sift",
        lonlat_rad=rng.random((4, 2), dtype=np.float32),
        scores=rng.random(4, dtype=np.float32),
        descriptors=rng.random((4, 8), dtype=np.float32),
        thumbnail=b"\xff\xd8 picture %d" % number if thumbnail else b"",
    )


def add(number: int) -> AddNode:
    """The operation that adds node `number`."""
    node = Node(node_id=number, stamp_ns=number + 1, pipeline="sift", keypoints=4)
    return AddNode(node=node, features=features(number))


@pytest.fixture
def told() -> Told:
    """Deltas in the order they were told."""
    return []


@pytest.fixture
def database_url(tmp_path: Path) -> str:
    """Where the tests keep their maps; the integration tests put a server in its place."""
    return f"sqlite:///{tmp_path}/maps.sqlite3"


@pytest.fixture
def database(database_url: str) -> Iterator[Database]:
    """An empty database."""
    opened = Database(database_url)
    yield opened
    opened.close()


@pytest.fixture
def store(database: Database, told: Told) -> MapStore:
    """A store with one empty map, "flat"."""
    ticks = count(1_000)
    opened = MapStore(database, lambda: next(ticks), told.append)
    opened.create("flat")
    told.clear()
    return opened


def app_of(store: MapStore, **options: Any) -> FastAPI:
    """REST over a store whose bus has no feature service."""

    def nobody(_wish: MatchRequest) -> MatchReply:
        raise AbsentError("nobody answers")

    return create_app(store, Merges(store, nobody), InspectionStore(store.database), **options)


@pytest.fixture
def client(store: MapStore) -> TestClient:
    """REST over a map with three nodes and two edges."""
    links = [PutEdge(edge=Edge(a=a, b=a + 1, raw_matches=60, inliers=40, s_min=30, s_max=60)) for a in (0, 1)]
    store.transact("flat", [add(0), add(1), add(2)], author="planner")
    store.transact("flat", links, author="planner")
    return TestClient(app_of(store), raise_server_exceptions=False)
