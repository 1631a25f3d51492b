"""The tables of the map store, in SQL that SQLite and PostgreSQL share."""

from sqlalchemy import (
    BigInteger,
    Boolean,
    Column,
    ForeignKey,
    ForeignKeyConstraint,
    Integer,
    LargeBinary,
    MetaData,
    String,
    Table,
    Text,
)

VERSION = 5
"""Raised with every change of these tables; `migration` brings older ones up, newer ones are refused."""


def _seal() -> Column[str]:
    """Checksum of the rest of the row, see `seals`; a row without one counts as damaged."""
    return Column("seal", String(64), nullable=False, server_default="")


metadata = MetaData()

about = Table("about", metadata, Column("version", Integer, primary_key=True), _seal())

maps = Table(
    "maps",
    metadata,
    Column("map_id", Integer, primary_key=True, autoincrement=True),
    Column("name", String(64), nullable=False, unique=True),
    Column("revision", BigInteger, nullable=False),
    Column("created_ns", BigInteger, nullable=False),
    Column("changed_ns", BigInteger, nullable=False),
    Column("node_count", Integer, nullable=False, server_default="0"),
    Column("edge_count", Integer, nullable=False, server_default="0"),
    _seal(),
    sqlite_autoincrement=True,  # an id is never given twice: caches are keyed by it
)

revisions = Table(
    "revisions",
    metadata,
    Column("map_id", ForeignKey("maps.map_id"), primary_key=True),
    Column("revision", BigInteger, primary_key=True),
    Column("author", String(64), nullable=False),
    Column("stamp_ns", BigInteger, nullable=False),
    Column("undoes", BigInteger),
    Column("steps", Integer, nullable=False),
    Column("content", LargeBinary, nullable=False),
    Column("sha256", String(64), nullable=False),
    _seal(),
)

blobs = Table(
    "blobs",
    metadata,
    Column("sha256", String(64), primary_key=True),
    Column("size", BigInteger, nullable=False),
    Column("data", LargeBinary, nullable=False),
)

map_blobs = Table(
    "map_blobs",
    metadata,
    Column("map_id", ForeignKey("maps.map_id"), primary_key=True),
    Column("sha256", ForeignKey("blobs.sha256"), primary_key=True, index=True),
)

nodes = Table(
    "nodes",
    metadata,
    Column("map_id", ForeignKey("maps.map_id"), primary_key=True),
    Column("node_id", BigInteger, primary_key=True, autoincrement=False),
    Column("revision", BigInteger, nullable=False),
    Column("record", Text, nullable=False),
    Column("features", ForeignKey("blobs.sha256"), nullable=False),
    Column("thumbnail", ForeignKey("blobs.sha256")),
    Column("quarantined", Boolean, nullable=False, default=False),  # of earlier versions, nobody reads it
    _seal(),
)

edges = Table(
    "edges",
    metadata,
    Column("map_id", Integer, primary_key=True),
    Column("a", BigInteger, primary_key=True, autoincrement=False),
    Column("b", BigInteger, primary_key=True, autoincrement=False),
    Column("revision", BigInteger, nullable=False),
    Column("record", Text, nullable=False),
    _seal(),
    ForeignKeyConstraint(["map_id", "a"], ["nodes.map_id", "nodes.node_id"]),
    ForeignKeyConstraint(["map_id", "b"], ["nodes.map_id", "nodes.node_id"]),
)

marks = Table(
    "marks",
    metadata,
    Column("map_id", ForeignKey("maps.map_id"), primary_key=True),
    Column("revision", BigInteger, nullable=False),
    Column("record", Text, nullable=False),  # all places and rules of the map: one row that cannot go unseen
    _seal(),
)

answers = Table(
    "answers",
    metadata,
    Column("number", BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=False),
    Column("request_id", String(64), nullable=False, unique=True),
    Column("map", String(64), nullable=False),
    Column("revision", BigInteger, nullable=False),
    _seal(),
)

missions = Table(
    "missions",
    metadata,
    Column("robot", String(64), primary_key=True),
    Column("epoch", BigInteger, nullable=False),
    Column("content", LargeBinary, nullable=False),
    Column("sha256", String(64), nullable=False),
    _seal(),
)

tasks = Table(
    "tasks",
    metadata,
    Column("robot", String(64), primary_key=True),
    Column("task_id", String(64), primary_key=True),
    Column("state", String(16), nullable=False, index=True),
    Column("started_ns", BigInteger, nullable=False),
    Column("ended_ns", BigInteger, nullable=False),
    Column("content", LargeBinary, nullable=False),
    Column("sha256", String(64), nullable=False),
    _seal(),
)

schedules = Table(
    "schedules",
    metadata,
    Column("robot", String(64), primary_key=True),
    Column("name", String(64), primary_key=True),
    Column("content", LargeBinary, nullable=False),
    Column("sha256", String(64), nullable=False),
    _seal(),
)

inspections = Table(
    "inspections",
    metadata,
    Column("number", BigInteger().with_variant(Integer, "sqlite"), primary_key=True, autoincrement=False),
    Column("map_id", ForeignKey("maps.map_id"), nullable=False),
    Column("place", String(128), nullable=False),  # its key: names that differ in case are one
    Column("mission", String(64), nullable=False),
    Column("round", BigInteger, nullable=False),
    Column("stamp_ns", BigInteger, nullable=False),
    Column("record", Text, nullable=False),
    Column("content", LargeBinary, nullable=False),  # the picture
    Column("sha256", String(64), nullable=False),
    _seal(),
)
