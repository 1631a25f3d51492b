"""Looking for damage: every row, every blob and the file itself are read and held against checksums."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from sqlalchemy import Connection, select

from services.map_store.errors import CorruptError
from services.map_store.history.replay import Replay, replay
from services.map_store.inspections import store as visits
from services.map_store.integrity.seals import intact
from services.map_store.storage import answers, blobs, catalogue
from services.map_store.storage.catalogue import MapRecord
from services.map_store.storage.database import Database
from services.map_store.storage.missions import sound
from services.map_store.storage.rows import parse_edge, parse_node
from services.map_store.storage.tables import edges, marks, missions, nodes
from services.map_store.tasks import records

Finding = tuple[str, str]
"""The damaged thing and the reason."""


@dataclass(frozen=True)
class Damage:
    """One damaged thing.

    Attributes:
        map: the map it belongs to; "" for what all maps share.
    """

    map: str
    thing: str
    reason: str


def check(database: Database, name: str | None = None) -> list[Damage]:
    """Everything that is damaged, or all of it in one map; MissingError when there is no such map."""
    found = [Damage("", "file", line) for line in database.inspect()]
    try:
        found += [Damage("", "file", line) for line in database.dangling()]
        with database.read() as connection:
            names = [catalogue.label(row) for row in catalogue.rows(connection)]
            if name is None:
                found += [Damage("", *finding) for finding in _missions(connection)]
                found += [Damage("", *finding) for finding in _answers(connection)]
                found += [Damage("", *finding) for finding in _tasks(connection)]
                found += [Damage("", *finding) for finding in _inspections(connection)]
    except CorruptError as error:
        return [*found, Damage("", "file", str(error))]
    for each in names if name is None else [name]:
        found += _check_map(database, each)
    return found


def rows(connection: Connection, found: MapRecord) -> Iterator[Finding]:
    """Rows that do not match their seals, then how many nodes and edges are missing or too many."""
    counts = []
    for table, parse in ((nodes, parse_node), (edges, parse_edge)):
        stored = connection.execute(select(table).where(table.c.map_id == found.map_id)).all()
        counts.append(len(stored))
        for row in stored:
            try:
                parse(row)
            except CorruptError as error:
                thing, _, reason = str(error).partition(": ")
                yield thing, reason
    yield from marks_row(connection, found)
    if counts != [found.node_count, found.edge_count]:
        expected = f"{found.node_count} nodes and {found.edge_count} edges expected"
        yield "graph", f"{expected}, got {counts[0]} and {counts[1]}"


def marks_row(connection: Connection, found: MapRecord) -> Iterator[Finding]:
    """The record of places and rules, where it does not match its seal."""
    try:
        catalogue.parse_marks(connection.execute(select(marks).where(marks.c.map_id == found.map_id)).first())
    except CorruptError as error:
        thing, _, reason = str(error).partition(": ")
        yield thing, reason


def lost_blobs(connection: Connection, found: MapRecord, used: Iterable[str]) -> dict[str, str]:
    """Checksums of blobs of a map, those `used` included, that are missing or damaged, with the reason."""
    owned = blobs.owned(connection, found.map_id)
    stray = {name: "it is not kept for this map" for name in used if name not in owned}
    return stray | blobs.unreadable(connection, owned.union(used))


def _check_map(database: Database, name: str) -> list[Damage]:
    try:
        with database.read() as connection:
            found = catalogue.find(connection, name)
            findings = list(rows(connection, found))
            findings += _history(replay(connection, found.map_id, found.revision), found.revision)
            findings += _contents(connection, found)
    except CorruptError as error:
        return [Damage(name, "map", str(error))]
    return [Damage(name, *finding) for finding in findings]


def _history(replayed: Replay, revision: int) -> Iterator[Finding]:
    """Entries of the history that cannot be read and were not given up, and entries too many."""
    yield from ((f"revision {number}", reason) for number, reason in replayed.damaged.items())
    if replayed.newest != revision:
        yield "history", f"{revision} revisions expected, got {replayed.newest}"


def _contents(connection: Connection, found: MapRecord) -> Iterator[Finding]:
    """Features and thumbnails: of a node when it has one, else of a revision that an undo may bring back."""
    used: dict[str, list[str]] = {}
    for row in connection.execute(select(nodes).where(nodes.c.map_id == found.map_id)).all():
        if not intact(nodes, row):  # listed already, and nobody knows what it refers to
            continue
        used.setdefault(row.features, []).append(f"features of node {row.node_id}")
        if row.thumbnail is not None:
            used.setdefault(row.thumbnail, []).append(f"thumbnail of node {row.node_id}")
    for name, reason in lost_blobs(connection, found, used).items():
        gone = [] if blobs.given_up(connection, name) else ["picture of a node that is gone"]
        yield from ((thing, reason) for thing in used.get(name, gone))
    for name in blobs.wrong_sizes(connection, found.map_id):
        yield f"blob {name!s:.12}", "its size is recorded wrongly"


def _missions(connection: Connection) -> Iterator[Finding]:
    for row in connection.execute(select(missions)).all():
        if not sound(row):
            yield f"mission of {row.robot!r}", "its record does not match its checksum"


def _tasks(connection: Connection) -> Iterator[Finding]:
    for name in records.damaged(connection):
        yield name, "its record does not match its checksum"


def _answers(connection: Connection) -> Iterator[Finding]:
    for number in answers.damaged(connection):
        yield f"answer {number}", "its record does not match its checksum"


def _inspections(connection: Connection) -> Iterator[Finding]:
    for number in visits.damaged(connection):
        yield f"inspection {number}", "it does not match its checksums"
