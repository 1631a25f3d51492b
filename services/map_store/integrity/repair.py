"""Mending one map: rows are written anew from the history; what is lost there too is removed."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from sqlalchemy import Connection, Row, delete, insert, select

from services.map_store.history import revisions as history
from services.map_store.history.replay import Replay, replay
from services.map_store.integrity import check
from services.map_store.integrity.seals import intact
from services.map_store.storage import answers, blobs, catalogue
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.graph import Graph, Key, Place, Step
from services.map_store.storage.missions import mend_missions
from services.map_store.storage.rows import edge_row, node_row, parse_edge, parse_node
from services.map_store.storage.tables import edges, map_blobs, maps, nodes
from shared.messages.maps import DeleteEdge, DeleteNode, Edge


@dataclass(frozen=True)
class Mended:
    """A map whose rows are sound again.

    Attributes:
        removed: steps that say what was lost; they cannot be taken back.
        done: what was done, in words.
    """

    found: MapRecord
    graph: Graph
    removed: tuple[Step, ...] = ()
    done: tuple[str, ...] = ()


@dataclass(frozen=True)
class Repaired:
    """The map after a repair, and what was done, in words."""

    name: str
    revision: int
    done: tuple[str, ...]


def mend(connection: Connection, name: str, now_ns: int) -> Mended:
    """Make rows, links and history of a map sound; the graph stays what it was as far as it is known."""
    _remove_strays(connection)
    blobs.name_again(connection)
    missions, forgotten = mend_missions(connection), answers.mend(connection)
    row = _record_of(connection, name)
    whole = intact(maps, row)
    told = replay(connection, row.map_id, row.revision if whole else 0)
    found, done = _record(row, whole, told, now_ns)
    mended = _mend_rows(connection, found, told, damaged=not whole)
    links = blobs.relink(connection, found.map_id, told.blobs | _blobs_of(mended.graph.places.values()))
    done += [f"{missions} records of missions written anew"] if missions else []
    done += [f"{forgotten} answers to requests removed"] if forgotten else []
    done += [f"{links} links to pictures written anew"] if links else []
    for number, reason in told.damaged.items():
        history.give_up(connection, found.map_id, number, now_ns)
        done.append(f"revision {number}: given up, {reason}; undo goes back to it and no further")
    if blobs.wrong_sizes(connection, found.map_id):
        blobs.measure(connection)
        done.append("sizes of blobs corrected")
    graph = mended.graph
    found = replace(found, node_count=len(graph.places), edge_count=len(graph.edges))
    catalogue.save(connection, found)
    return replace(mended, found=found, done=(*done, *mended.done))


def relink_all(connection: Connection) -> None:
    """Link every map to its blobs anew: links hold nothing but what their indexes repeat."""
    blobs.name_again(connection)
    for row in catalogue.rows(connection):
        told = replay(connection, row.map_id, row.revision if intact(maps, row) else 0)
        stored = connection.execute(select(nodes).where(nodes.c.map_id == row.map_id)).all()
        places = _good(stored, ()).places.values()
        blobs.relink(connection, row.map_id, told.blobs | _blobs_of(places))


def _blobs_of(places: Iterable[Place]) -> set[str]:
    return {name for place in places for name in (place.features, place.thumbnail) if name}


def _record_of(connection: Connection, name: str) -> Row[Any]:
    for row in catalogue.rows(connection):
        if catalogue.label(row) == name:
            return row
    raise catalogue.missing(connection, name)


def _record(row: Row[Any], whole: bool, told: Replay, now_ns: int) -> tuple[MapRecord, list[str]]:
    """The record of the map, made up from its history when it is damaged."""
    if whole:
        return catalogue.record_of(row), []
    name = catalogue.label(row)
    created_ns = (
        row.created_ns if isinstance(row.created_ns, int) and 0 <= row.created_ns <= now_ns else now_ns
    )
    record = MapRecord(row.map_id, name, told.newest, created_ns, now_ns)
    return record, [f"record of the map: written anew, at revision {told.newest}"]


def _mend_rows(connection: Connection, found: MapRecord, told: Replay, damaged: bool) -> Mended:
    stored = connection.execute(select(nodes).where(nodes.c.map_id == found.map_id)).all()
    links = connection.execute(select(edges).where(edges.c.map_id == found.map_id)).all()
    good = _good(stored, links)
    findings = [] if damaged else list(check.rows(connection, found))
    if not findings and (told.graph is None or told.graph == good):
        return Mended(found, good)
    truth = told.graph or good
    _write_rows(connection, found, truth, told, [*stored, *links])
    if told.graph is not None:
        done = [f"{thing}: written anew from the history" for thing, _ in findings]
        return Mended(found, truth, (), tuple(done or ["graph: written anew from the history"]))
    done = [f"{thing}: removed, {reason}" for thing, reason in findings]
    return Mended(found, truth, _removed(stored, links, truth), tuple(done))


def _good(stored: Iterable[Row[Any]], links: Iterable[Row[Any]]) -> Graph:
    """The rows that match their seals; edges only between such nodes."""
    places = {row.node_id: parse_node(row) for row in stored if intact(nodes, row)}
    joined = {(row.a, row.b): parse_edge(row) for row in links if intact(edges, row)}
    kept = {key: edge for key, edge in joined.items() if {*key} <= places.keys()}
    return Graph(dict(sorted(places.items())), dict(sorted(kept.items())))


def _removed(
    stored: Iterable[Row[Any]], links: Iterable[Row[Any]], truth: Graph
) -> tuple[DeleteNode | DeleteEdge, ...]:
    gone = {row.node_id for row in stored if isinstance(row.node_id, int)} - truth.places.keys()
    cut = {(row.a, row.b) for row in links if intact(edges, row)} - truth.edges.keys()
    steps = [DeleteEdge(a=a, b=b) for a, b in sorted(cut)]
    return (*steps, *(DeleteNode(node_id=node_id) for node_id in sorted(gone) if node_id >= 0))


def _write_rows(
    connection: Connection, found: MapRecord, graph: Graph, told: Replay, before: list[Row[Any]]
) -> None:
    """Write all rows of a graph anew; good rows stay as they were."""
    for table in (edges, nodes):
        connection.execute(delete(table).where(table.c.map_id == found.map_id))
    kept = {_key(row): row._mapping for row in before if intact(edges if "a" in row._mapping else nodes, row)}

    def row_of(key: int | Key, thing: Place | Edge) -> dict[str, Any]:
        old: Mapping[Any, Any] = kept.get(key, {})
        revision = old.get("revision", told.written.get(key, found.revision))
        if isinstance(thing, Edge):
            return edge_row(found.map_id, revision, thing)
        return node_row(found.map_id, revision, thing, old.get("quarantined", False))

    for table, things in ((nodes, graph.places), (edges, graph.edges)):
        made = [row_of(key, thing) for key, thing in things.items()]
        if made:
            connection.execute(insert(table), made)


def _key(row: Row[Any]) -> int | Key:
    return (row.a, row.b) if "a" in row._mapping else row.node_id


def _remove_strays(connection: Connection) -> None:
    """Rows of maps that are not there: damage changed the number of their map."""
    known = select(maps.c.map_id)
    for table in (edges, nodes):
        rows = connection.execute(select(table).where(table.c.map_id.not_in(known))).all()
        for row in rows:
            if not intact(table, row):
                same = (column == row._mapping[column.name] for column in table.primary_key)
                connection.execute(delete(table).where(*same))
    connection.execute(delete(map_blobs).where(map_blobs.c.map_id.not_in(known)))
