"""What a revision did, in a few words: "node 12 added, 3 edges put"."""

import threading
from collections import OrderedDict
from collections.abc import Collection, Mapping, Sequence
from typing import Any

from sqlalchemy import Connection, select

from services.map_store.errors import CorruptError
from services.map_store.storage.rows import read_history
from services.map_store.storage.tables import revisions

RawStep = Mapping[str, Any]
"""A step as it is stored. Checking it as a `Step` takes five times as long, and only names are read here."""

CACHED = 10_000
"""Ten times what REST lists at once; 2.6 MB (tracemalloc, of lines like the one above)."""

SENTENCES = (
    ("add_node", "node", "added"),
    ("update_node", "node", "updated"),
    ("delete_node", "node", "deleted"),
    ("put_edge", "edge", "put"),
    ("delete_edge", "edge", "deleted"),
    ("put_place", "place", "named"),
    ("delete_place", "place", "forgotten"),
    ("put_rule", "rule", "put"),
    ("delete_rule", "rule", "lifted"),
    ("put_route", "route", "put"),
    ("delete_route", "route", "forgotten"),
    ("put_sign", "sign", "read"),
    ("delete_sign", "sign", "forgotten"),
)


def summarise(steps: Sequence[RawStep], inverse: Sequence[RawStep]) -> str:
    """Say what `steps` did; a thing they touched twice in the same way counts once.

    Args:
        steps: of one revision.
        inverse: those that lead back; they tell the edges that went with deleted nodes.
    """
    named: dict[str, set[str]] = {operation: set() for operation, _, _ in SENTENCES}
    for step in steps:
        named[step["op"]].add(_name(step))
    lost = _edge_steps(inverse) - _edge_steps(steps)
    parts = []
    for operation, thing, done in SENTENCES:
        if named[operation]:
            part = f"{_things(thing, named[operation])} {done}"
            with_edges = operation == "delete_node" and lost > 0
            parts.append(f"{part} with {lost} edge{'s' * (lost != 1)}" if with_edges else part)
    return ", ".join(parts)


class Summaries:
    """A cache by the checksum of the stored steps: listing a history again reads none of them."""

    def __init__(self) -> None:
        self._summaries: OrderedDict[str, str] = OrderedDict()
        self._lock = threading.Lock()

    def of(self, connection: Connection, map_id: int, revision: int, sha256: str) -> str:
        """The summary of one revision; of damaged steps it says so, and the list stays readable."""
        with self._lock:
            summary = self._summaries.get(sha256)
        if summary is not None:
            return summary
        query = select(revisions.c.content).where(
            revisions.c.map_id == map_id, revisions.c.revision == revision
        )
        try:
            fields = read_history(connection.execute(query).scalar_one(), sha256)
        except CorruptError as error:
            return f"unreadable: {error}"
        summary = summarise(fields["steps"], fields["inverse"])
        with self._lock:
            self._summaries[sha256] = summary
            while len(self._summaries) > CACHED:
                self._summaries.popitem(last=False)
        return summary


def _name(step: RawStep) -> str:
    match step["op"]:
        case "add_node":
            return str(step["place"]["node"]["node_id"])
        case "update_node":
            return str(step["node"]["node_id"])
        case "delete_node":
            return str(step["node_id"])
        case "put_place":
            return repr(step["place"]["name"])
        case "put_rule":
            return repr(step["rule"]["name"])
        case "put_route":
            return repr(step["route"]["name"])
        case "put_sign":
            return repr(step["sign"]["name"])
        case "delete_place" | "delete_rule" | "delete_route" | "delete_sign":
            return repr(step["name"])
    edge = step.get("edge", step)
    return f"{edge['a']}-{edge['b']}"


def _edge_steps(steps: Sequence[RawStep]) -> int:
    return sum(step["op"] in ("put_edge", "delete_edge") for step in steps)


def _things(thing: str, names: Collection[str]) -> str:
    return f"{thing} {next(iter(names))}" if len(names) == 1 else f"{len(names)} {thing}s"
