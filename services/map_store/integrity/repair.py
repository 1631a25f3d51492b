"""Mending one map: rows are written anew from the history; what is lost there too is removed."""

from dataclasses import dataclass, replace
from typing import Any

from sqlalchemy import Connection, Row, delete, select

from services.map_store.history import revisions as history
from services.map_store.history.replay import Replay, replay
from services.map_store.history.revisions import Revision
from services.map_store.inspections import store as visits
from services.map_store.integrity.check import lost_blobs
from services.map_store.integrity.row_repair import intact_graph, mend_rows
from services.map_store.integrity.seals import intact
from services.map_store.storage import answers, blobs, catalogue
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.graph import AddStoredNode, Graph, Step, apply, put
from services.map_store.storage.missions import mend_missions
from services.map_store.storage.tables import edges, map_blobs, maps, marks, nodes
from services.map_store.tasks import records
from shared.mapgraph.marks import nodes_of, only_nodes
from shared.messages.maps import DeleteNode, PutEdge


@dataclass(frozen=True)
class Repaired:
    """The map after a repair, and what was done, in words."""

    map: str
    revision: int
    done: tuple[str, ...]


def repair(connection: Connection, name: str, author: str, now_ns: int) -> tuple[MapRecord, list[str]]:
    """Make a map sound; what had to be removed is a new revision, as far as it is known.

    Returns:
        The record of the map afterwards, and what was done, in words.
    """
    _remove_strays(connection)
    blobs.name_again(connection)
    missions, forgotten = mend_missions(connection), answers.mend(connection)
    errands = records.mend(connection)
    unseen = visits.mend(connection)
    row = _row_of(connection, name)
    whole = intact(maps, row)
    replayed = replay(connection, row.map_id, row.revision if whole else 0)
    found, done = _record(row, whole, replayed, now_ns)
    graph, removed, mended = mend_rows(connection, found, replayed, damaged=not whole)
    links = blobs.relink(connection, found.map_id, replayed.blobs | _blobs_of(graph))
    done += [f"{missions} records of missions written anew"] if missions else []
    done += [f"{forgotten} answers to requests removed"] if forgotten else []
    done += [f"{errands} tasks and schedules removed, their records are lost"] if errands else []
    done += [f"{unseen} inspections removed"] if unseen else []
    done += [f"{links} links to pictures written anew"] if links else []
    for number, reason in replayed.damaged.items():
        history.give_up(connection, found.map_id, number, now_ns)
        done.append(f"revision {number}: given up, {reason}; undo goes back to it and no further")
    if blobs.wrong_sizes(connection, found.map_id):
        blobs.measure(connection)
        done.append("sizes of blobs corrected")
    found = replace(found, node_count=len(graph.nodes), edge_count=len(graph.edges))
    catalogue.save(connection, found)
    steps, lost = _give_up_blobs(connection, found, graph)
    if removed or steps:
        entry = Revision(found.revision + 1, author, now_ns, len(removed) + len(steps), None)
        found = history.record(connection, found, entry, removed + steps, apply(graph, steps))
    return found, done + mended + lost


def relink_all(connection: Connection) -> None:
    """Link every map to its blobs anew: links hold nothing but what their indexes repeat."""
    blobs.name_again(connection)
    for row in catalogue.rows(connection):
        replayed = replay(connection, row.map_id, row.revision if intact(maps, row) else 0)
        stored = connection.execute(select(nodes).where(nodes.c.map_id == row.map_id)).all()
        blobs.relink(connection, row.map_id, replayed.blobs | _blobs_of(intact_graph(stored, ())))


def _blobs_of(graph: Graph) -> set[str]:
    return {name for stored in graph.nodes.values() for name in stored.blobs}


def _row_of(connection: Connection, name: str) -> Row[Any]:
    for row in catalogue.rows(connection):
        if catalogue.label(row) == name:
            return row
    raise catalogue.missing(connection, name)


def _record(row: Row[Any], whole: bool, replayed: Replay, now_ns: int) -> tuple[MapRecord, list[str]]:
    """The record of the map, made up from its history when it is damaged."""
    if whole:
        return catalogue.record_of(row), []
    created_ns = row.created_ns if isinstance(row.created_ns, int) else now_ns
    if not 0 <= created_ns <= now_ns:
        created_ns = now_ns
    record = MapRecord(row.map_id, catalogue.label(row), replayed.newest, created_ns, now_ns)
    return record, [f"record of the map: written anew, at revision {replayed.newest}"]


def _give_up_blobs(
    connection: Connection, found: MapRecord, graph: Graph
) -> tuple[tuple[Step, ...], list[str]]:
    """Empty the blobs that are lost, so that they are known as such.

    Returns:
        Steps that delete nodes without features and put nodes without a thumbnail in the place of those with
        one, and the same in words.
    """
    used = _blobs_of(graph)
    lost = lost_blobs(connection, found, used)
    new = {name for name in lost if not blobs.given_up(connection, name)}
    for name in new:
        blobs.give_up(connection, name)
    gone = {node_id: stored for node_id, stored in graph.nodes.items() if stored.features in lost}
    bare = {n: stored for n, stored in graph.nodes.items() if stored.thumbnail in lost and n not in gone}
    steps: list[Step] = [DeleteNode(node_id=node_id) for node_id in sorted(gone | bare)]
    steps += [AddStoredNode(place=old.model_copy(update={"thumbnail": ""})) for old in bare.values()]
    for key, edge in sorted(graph.edges.items()):
        if bare.keys() & key and not gone.keys() & key:
            steps.append(PutEdge(edge=edge))
    kept = graph.nodes.keys() - gone.keys()
    marked = graph.marks
    for mark in (*marked.places, *marked.rules, *marked.routes, *marked.signs):
        if bare.keys() & nodes_of(mark):  # they left it when they were deleted
            steps.append(put(only_nodes(mark, kept)))
    done = [f"node {node_id}: removed, its features are lost" for node_id in gone]
    done += [f"node {node_id}: its thumbnail is lost" for node_id in bare]
    history_only = len(new - used)
    done += [f"{history_only} pictures of nodes that are gone are lost"] if history_only else []
    return tuple(steps), done


def _remove_strays(connection: Connection) -> None:
    """Rows of maps that are not there: damage changed the number of their map."""
    known = select(maps.c.map_id)
    for table in (edges, nodes, marks):
        rows = connection.execute(select(table).where(table.c.map_id.not_in(known))).all()
        for row in rows:
            if not intact(table, row):
                same = (column == row._mapping[column.name] for column in table.primary_key)
                connection.execute(delete(table).where(*same))
    connection.execute(delete(map_blobs).where(map_blobs.c.map_id.not_in(known)))
