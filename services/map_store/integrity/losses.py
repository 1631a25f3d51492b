"""Blobs that cannot be read any more: found, given up, and taken out of the graph."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from sqlalchemy import Connection, insert, select, update

from services.map_store.errors import CorruptError
from services.map_store.storage import blobs
from services.map_store.storage.graph import AddPlace, Change, Graph, Place, Step, apply
from services.map_store.storage.tables import blobs as kept
from services.map_store.storage.tables import map_blobs
from shared.messages.maps import DeleteNode, PutEdge


@dataclass(frozen=True)
class Losses:
    """How a graph goes on without what is lost.

    Attributes:
        steps: delete nodes without features; put nodes without a thumbnail in the place of those with one.
        change: what they do.
        done: the same in words.
    """

    steps: tuple[Step, ...]
    change: Change
    done: tuple[str, ...]


def unreadable(connection: Connection, map_id: int, used: Iterable[str] = ()) -> dict[str, str]:
    """Checksums of blobs of the map, those `used` included, that are missing or damaged, with the reason."""
    owned = select(map_blobs.c.sha256).where(map_blobs.c.map_id == map_id)
    linked = {name for name in connection.execute(owned).scalars() if isinstance(name, str)}
    lost = {name: "it is not kept for this map" for name in used if name not in linked}
    for name in sorted(linked.union(used)):
        try:
            blobs.get(connection, name)
        except CorruptError as error:
            lost[name] = str(error)
    return lost


def given_up(connection: Connection, name: str) -> bool:
    """Whether a repair emptied this blob because its bytes were damaged."""
    return connection.execute(select(kept.c.data).where(kept.c.sha256 == name)).scalar() == b""


def take_out(connection: Connection, map_id: int, graph: Graph) -> Losses:
    """Empty the blobs that are lost, so that they are known as such, and leave out what needs them."""
    used = {name for p in graph.places.values() for name in (p.features, p.thumbnail) if name}
    lost = unreadable(connection, map_id, used)
    new = {name: reason for name, reason in lost.items() if not given_up(connection, name)}
    for name in new:
        _give_up(connection, name)
    blind = [place for place in graph.places.values() if place.features in lost]
    bare = [p for p in graph.places.values() if p.thumbnail in lost and p.features not in lost]
    steps = _steps(graph, blind, bare)
    done = [f"node {place.node.node_id}: removed, its features are lost" for place in blind]
    done += [f"node {place.node.node_id}: its thumbnail is lost" for place in bare]
    past = len(new.keys() - used)
    done += [f"{past} pictures of nodes that are gone are lost"] if past else []
    return Losses(steps, apply(graph, steps), tuple(done))


def _steps(graph: Graph, blind: list[Place], bare: list[Place]) -> tuple[Step, ...]:
    gone = {place.node.node_id for place in blind}
    anew = {place.node.node_id for place in bare}
    steps: list[Step] = [DeleteNode(node_id=node_id) for node_id in sorted(gone | anew)]
    steps += [AddPlace(place=place.model_copy(update={"thumbnail": ""})) for place in bare]
    for (a, b), edge in sorted(graph.edges.items()):
        if {a, b} & anew and not {a, b} & gone:
            steps.append(PutEdge(edge=edge))
    return tuple(steps)


def _give_up(connection: Connection, name: str) -> None:
    values: Mapping[str, object] = {"data": b"", "size": 0}
    written = connection.execute(update(kept).where(kept.c.sha256 == name).values(values))
    if written.rowcount == 0:  # histories and links refer to it: an undo must not fail for want of the row
        connection.execute(insert(kept).values({**values, "sha256": name}))
