"""Mending the rows of nodes and edges of one map: from its history, or from those that are intact."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from sqlalchemy import Connection, Row, delete, insert, select

from services.map_store.history.replay import Replay
from services.map_store.integrity import check
from services.map_store.integrity.seals import intact
from services.map_store.storage.catalogue import MapRecord, parse_marks, write_marks
from services.map_store.storage.graph import Graph, Step, StoredNode
from services.map_store.storage.rows import edge_row, node_row, parse_edge, parse_node
from services.map_store.storage.tables import edges, marks, nodes
from shared.mapgraph.marks import by_key, only_nodes
from shared.mapgraph.operations import EdgeKey
from shared.messages.maps import DeleteEdge, DeleteNode, Edge
from shared.messages.places import Marks

Rows = Sequence[Row[Any]]


def mend_rows(
    connection: Connection, found: MapRecord, replayed: Replay, damaged: bool
) -> tuple[Graph, tuple[Step, ...], list[str]]:
    """Make the rows of nodes and edges say what the history says, or where it is damaged what they can.

    Returns:
        The graph, steps that say what was removed and cannot be taken back, and what was done in words.
    """
    stored = connection.execute(select(nodes).where(nodes.c.map_id == found.map_id)).all()
    joined = connection.execute(select(edges).where(edges.c.map_id == found.map_id)).all()
    good = intact_graph(stored, joined, _intact_marks(connection, found))
    findings = list((check.marks_row if damaged else check.rows)(connection, found))
    if not findings and replayed.graph in (None, good):
        return good, (), []
    graph = replayed.graph or good
    _write_rows(connection, found, graph, replayed, [*stored, *joined])
    write_marks(connection, found.map_id, found.revision, graph.marks)
    if replayed.graph is None:
        done = [f"{thing}: removed, {reason}" for thing, reason in findings]
        return graph, _removed(stored, joined, graph), done
    done = [f"{thing}: written anew from the history" for thing, _ in findings]
    return graph, (), done or ["graph: written anew from the history"]


def _intact_marks(connection: Connection, found: MapRecord) -> Marks:
    """All marks; none where their record is damaged."""
    row = connection.execute(select(marks).where(marks.c.map_id == found.map_id)).first()
    return parse_marks(row) if row is not None and intact(marks, row) else Marks()


def intact_graph(
    stored: Iterable[Row[Any]], joined: Iterable[Row[Any]], written: Marks | None = None
) -> Graph:
    """The rows that match their seals; edges only between such nodes, marks only of such."""
    written = written or Marks()
    good = {row.node_id: parse_node(row) for row in stored if intact(nodes, row)}
    between = {(row.a, row.b): parse_edge(row) for row in joined if intact(edges, row)}
    kept = {key: edge for key, edge in between.items() if {*key} <= good.keys()}
    return Graph(
        dict(sorted(good.items())),
        dict(sorted(kept.items())),
        by_key(only_nodes(place, good.keys()) for place in written.places),
        by_key(only_nodes(rule, good.keys()) for rule in written.rules),
        by_key(only_nodes(route, good.keys()) for route in written.routes),
        by_key(only_nodes(sign, good.keys()) for sign in written.signs),
    )


def _removed(stored: Rows, joined: Rows, graph: Graph) -> tuple[Step, ...]:
    gone = {row.node_id for row in stored if isinstance(row.node_id, int)} - graph.nodes.keys()
    cut = {(row.a, row.b) for row in joined if intact(edges, row)} - graph.edges.keys()
    steps = [DeleteEdge(a=a, b=b) for a, b in sorted(cut)]
    return (*steps, *(DeleteNode(node_id=node_id) for node_id in sorted(gone) if node_id >= 0))


def _write_rows(
    connection: Connection, found: MapRecord, graph: Graph, replayed: Replay, before: Rows
) -> None:
    """Write all rows of a graph anew; what good rows say of their revision stays."""
    for table in (edges, nodes):
        connection.execute(delete(table).where(table.c.map_id == found.map_id))
    written: dict[int | EdgeKey, int] = dict(replayed.written)
    for row in before:
        key, table = ((row.a, row.b), edges) if "a" in row._mapping else (row.node_id, nodes)
        if intact(table, row):
            written[key] = row.revision

    def row_of(key: int | EdgeKey, thing: StoredNode | Edge) -> dict[str, Any]:
        revision = written.get(key, found.revision)
        if isinstance(thing, Edge):
            return edge_row(found.map_id, revision, thing)
        return node_row(found.map_id, revision, thing)

    things: tuple[tuple[Any, Mapping[Any, StoredNode | Edge]], ...]
    things = ((nodes, graph.nodes), (edges, graph.edges))
    for table, kept in things:
        if kept:
            connection.execute(insert(table), [row_of(key, thing) for key, thing in kept.items()])
