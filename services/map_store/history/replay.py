"""The graph once more, out of the history alone: what damaged rows are mended from."""

from collections.abc import Mapping
from dataclasses import dataclass

from sqlalchemy import Connection, func, select

from services.map_store.errors import CorruptError, GivenUpError, MapError
from services.map_store.history import revisions as history
from services.map_store.storage.graph import AddStoredNode, Graph, Step, added_by, apply
from services.map_store.storage.tables import revisions
from shared.mapgraph.operations import EdgeKey
from shared.messages.maps import DeleteEdge, DeleteNode, PutEdge, UpdateNode


@dataclass(frozen=True)
class Replay:
    """What the history of a map tells.

    Attributes:
        newest: number of its newest revision.
        damaged: revisions whose operations cannot be read, with the reason; not those given up.
        graph: what all operations lead to; None when some are damaged or given up.
        written: the revision that wrote each node and edge last, by number or by pair of numbers.
        blobs: checksums that the readable operations name.
    """

    newest: int
    damaged: Mapping[int, str]
    graph: Graph | None
    written: Mapping[int | EdgeKey, int]
    blobs: frozenset[str]


def replay(connection: Connection, map_id: int, at_least: int = 0) -> Replay:
    """Read all operations of a map; entries up to revision `at_least` must be there."""
    last = connection.execute(select(func.max(revisions.c.revision)).where(revisions.c.map_id == map_id))
    newest = max(last.scalar() or 0, at_least)
    done: list[Step] = []
    whole = True
    damaged: dict[int, str] = {}
    written: dict[int | EdgeKey, int] = {}
    for number in range(1, newest + 1):
        try:
            steps = history.steps_of(connection, map_id, number, inverse=False)
        except CorruptError as error:
            whole = False
            if not isinstance(error, GivenUpError):
                damaged[number] = str(error).removeprefix(f"revision {number}: ")
            continue
        done += steps
        written |= {key: number for step in steps if (key := _key(step)) is not None}
    named = {sha256 for stored in added_by(done) for sha256 in stored.blobs}
    return Replay(newest, damaged, _applied(done) if whole else None, written, frozenset(named))


def _applied(steps: list[Step]) -> Graph | None:
    try:
        return apply(Graph(), steps).graph
    except MapError:
        return None


def _key(step: Step) -> int | EdgeKey | None:
    """The node or edge that a step writes; None where it writes a place or a rule."""
    match step:
        case AddStoredNode(place=stored):
            return stored.node_id
        case UpdateNode(node=node):
            return node.node_id
        case PutEdge(edge=edge):
            return edge.a, edge.b
        case DeleteNode(node_id=node_id):
            return node_id
        case DeleteEdge(a=a, b=b):
            return a, b
    return None
