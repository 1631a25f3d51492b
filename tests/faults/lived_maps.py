"""A database as years of use leave it, and everything a client can be told of it."""

from itertools import count
from pathlib import Path
from typing import Any

import numpy as np
from sqlalchemy import select

from services.map_store.errors import MapError
from services.map_store.history import revisions as history
from services.map_store.storage import tables
from services.map_store.storage.database import Database
from services.map_store.storage.graph import MAX_NODE_ID
from services.map_store.storage.missions import MissionStore
from services.map_store.store import MapStore
from shared.messages.features import Features
from shared.messages.maps import AddNode, DeleteEdge, DeleteNode, Edge, Node, PutEdge, UpdateNode
from shared.wire import encode

ROBOT = "r1"


def place(number: int, keypoints: int = 24) -> AddNode:
    """The operation that adds node `number`, always with the same content."""
    rng = np.random.default_rng(number)
    features = Features(
        pipeline="sift",
        lonlat_rad=rng.random((keypoints, 2), dtype=np.float32),
        scores=rng.random(keypoints, dtype=np.float32),
        descriptors=rng.random((keypoints, 16), dtype=np.float32),
        thumbnail=b"\xff\xd8" + rng.bytes(600),
    )
    return AddNode(
        node=Node(node_id=number, stamp_ns=number + 1, pipeline="sift", keypoints=keypoints),
        features=features,
    )


def link(a: int, b: int, inliers: int = 40) -> PutEdge:
    """The operation that joins two nodes."""
    return PutEdge(edge=Edge(a=a, b=b, raw_matches=60, inliers=inliers, heading_ab_rad=0.5, why="test"))


def opened(file: Path) -> MapStore:
    """A store on the database in `file`."""
    ticks = count(1_000)
    return MapStore(Database(f"sqlite:///{file}"), lambda: next(ticks), lambda _: None)


def live(file: Path, nodes: int = 12) -> None:
    """Write three maps with updates, deletions and undos, a mission, and free pages where a map was."""
    store = opened(file)
    for first, name in enumerate(("attic", "flat", "house")):
        store.create(name)
        for number in range(nodes):
            at = 100 * first + number
            joined = [link(at - 1, at)] if number else []
            store.transact(name, [place(at), *joined], author="planner")
        first_id = 100 * first
        store.transact(name, [UpdateNode(node=Node(node_id=first_id, pipeline="sift", keypoints=24))])
        store.transact(name, [link(first_id, first_id + 1, 50), DeleteEdge(a=first_id + 1, b=first_id + 2)])
        store.transact(name, [DeleteNode(node_id=first_id + 3)], author="rest")
        store.undo(name, "rest")
        store.transact(name, [DeleteNode(node_id=first_id + 4)], author="rest")
    store.create("gone")
    store.transact("gone", [place(900 + number) for number in range(4)])
    store.delete("gone")
    missions = MissionStore(store.database)
    missions.save(missions.claim(ROBOT).model_copy(update={"mission_id": "m-1", "step": 7}))
    store.database.close()


def told_of(store: MapStore, name: str) -> dict[str, Any]:
    """Everything a client can read of one map, each under its name; raises MapError."""
    revision, graph = store.graph(name)
    told: dict[str, Any] = {"revision": revision, "record": store.summary(name)}
    told |= {f"node {node_id}": node for node_id, node in graph.nodes.items()}
    told |= {f"edge {a}-{b}": edge for (a, b), edge in graph.edges.items()}
    for found in store.contents.features(name, [])[1]:
        told[f"features of node {found.node_id}"] = encode(found.features)
    for node_id, node in graph.nodes.items():
        told[f"thumbnail of node {node_id}"] = _or_refused(store.contents.read, name, node, "thumbnail")
    for entry in store.revisions(name, MAX_NODE_ID, 1000):
        told[f"revision {entry.revision}"] = None if entry.summary.startswith("unreadable") else entry
    with store.database.read() as connection:
        map_id = store.summary(name).map_id
        for number in range(1, revision + 1):
            told[f"way back over {number}"] = _or_refused(
                history.steps_of, connection, map_id, number, inverse=True
            )
    return told


def rows_of(store: MapStore) -> dict[str, list[tuple[Any, ...]]]:
    """All rows of all tables."""
    with store.database.read() as connection:
        return {
            table.name: [tuple(row) for row in connection.execute(select(table).order_by(*table.primary_key))]
            for table in tables.metadata.sorted_tables
        }


def _or_refused(read: Any, *args: Any, **fields: Any) -> Any:
    try:
        return read(*args, **fields)
    except MapError:
        return None
