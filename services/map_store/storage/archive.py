"""A map as one file: a zip of `map.json` and `blobs/<sha256>`; the same map gives the same bytes."""

import zipfile
import zlib
from collections.abc import Callable
from os import SEEK_END
from typing import IO, Literal

from pydantic import Field, ValidationError

from services.map_store.errors import CorruptError, InvalidError, MapError
from services.map_store.storage.blobs import checksum, unpack_features
from services.map_store.storage.contents import Kind
from services.map_store.storage.graph import AddStoredNode, Graph, Step, StoredNode, apply
from services.map_store.storage.zip_opening import open_zip
from shared.mapgraph.mark_draft import MARKS_MAX
from shared.messages.base import Name, Part
from shared.messages.features import MAX_THUMBNAIL_BYTES
from shared.messages.maps import Edge, PutEdge
from shared.messages.places import Place, PutPlace, PutRoute, PutRule, PutSign, Route, Rule, Sign, key_of
from shared.topics import FEATURES
from shared.wire import MAX_CONTAINER

INDEX = "map.json"
BLOBS = "blobs/"
MAX_INDEX_BYTES = 64_000_000
"""Twice what the largest map needs: MAX_CONTAINER nodes of 0.8 kB and as many edges of 0.6 kB."""
MAX_UNPACKED = 4
"""Times the length of the archive that its entries may have: ours are not packed, zip tools halve them."""
SMALL_BYTES = 16_000_000
"""Chosen: what any archive may unpack to; an index of many nodes packs well."""
MAX_DIRECTORY_BYTES = 10_000_000
"""Twice what a map with as many nodes as the bus carries needs for their two blobs each."""
EPOCH = (1980, 1, 1, 0, 0, 0)
"""Time stamp of every entry: the earliest a zip can hold."""


class Index(Part):
    """`map.json`: the graph and the checksums of its blobs.

    Attributes:
        places: nodes, by their name in the first archives; `named_places` are what people named.
    """

    format: Literal["topnav-map.v1"] = "topnav-map.v1"
    name: Name
    revision: int = Field(ge=0)
    places: tuple[StoredNode, ...] = Field(max_length=MAX_CONTAINER)
    edges: tuple[Edge, ...] = Field(max_length=MAX_CONTAINER)
    named_places: tuple[Place, ...] = Field(default=(), max_length=MARKS_MAX)
    rules: tuple[Rule, ...] = Field(default=(), max_length=MARKS_MAX)
    routes: tuple[Route, ...] = Field(default=(), max_length=MARKS_MAX)
    signs: tuple[Sign, ...] = Field(default=(), max_length=MARKS_MAX)


def write_archive(
    file: IO[bytes], name: str, revision: int, graph: Graph, read_blob: Callable[[StoredNode, Kind], bytes]
) -> None:
    """Write one map; `read_blob(node, kind)` gives the bytes of its "features" or "thumbnail"."""
    nodes = tuple(graph.nodes[node_id] for node_id in sorted(graph.nodes))
    edges = tuple(graph.edges[key] for key in sorted(graph.edges))
    marks = graph.marks
    index = Index(
        name=name,
        revision=revision,
        places=nodes,
        edges=edges,
        named_places=marks.places,
        rules=marks.rules,
        routes=marks.routes,
        signs=marks.signs,
    )
    owners: dict[str, tuple[StoredNode, Kind]] = {stored.features: (stored, "features") for stored in nodes}
    owners |= {stored.thumbnail: (stored, "thumbnail") for stored in nodes if stored.thumbnail}
    with zipfile.ZipFile(file, "w", zipfile.ZIP_STORED) as archive:
        _write(archive, INDEX, index.model_dump_json(indent=1).encode())
        for sha256 in sorted(owners):
            _write(archive, BLOBS + sha256, read_blob(*owners[sha256]))


def _write(archive: zipfile.ZipFile, name: str, data: bytes) -> None:
    entry = zipfile.ZipInfo(name, EPOCH)
    entry.create_system, entry.external_attr = 3, 0o644 << 16  # as on Unix, wherever it is written
    archive.writestr(entry, data)


class Archive:
    """An archive that was checked as a whole: its graph is valid and all its blobs are there and intact.

    Args:
        file: the zip, open for reading as long as this object is used.
        max_bytes: most bytes all entries may have together when unpacked.

    Raises:
        InvalidError: it is not such an archive; the text names what is wrong.
    """

    def __init__(self, file: IO[bytes], max_bytes: int) -> None:
        self._zip = open_zip(file, MAX_DIRECTORY_BYTES)
        self._check_entries(min(max_bytes, max(SMALL_BYTES, MAX_UNPACKED * file.seek(0, SEEK_END))))
        self.index = self._read_index()
        self._features = {node.features for node in self.index.places}
        self.steps = self._check_graph()
        self._check_blobs()

    def blob(self, sha256: str) -> bytes:
        """Bytes of one blob, no longer than the bus carries of its kind."""
        most_bytes = FEATURES.max_bytes if sha256 in self._features else MAX_THUMBNAIL_BYTES
        data = self._read(BLOBS + sha256, most_bytes)
        if checksum(data) != sha256:
            raise InvalidError(f"{BLOBS}{sha256[:12]}: does not match its checksum")
        return data

    def _check_entries(self, max_bytes: int) -> None:
        entries = self._zip.infolist()
        names = {entry.filename for entry in entries}
        if len(names) != len(entries) or INDEX not in names:
            raise InvalidError(f"archive must hold {INDEX} and every entry once, got {len(entries)} entries")
        for entry in entries:
            if entry.filename != INDEX and not _is_blob_name(entry.filename):
                raise InvalidError(f"entry must be {INDEX} or {BLOBS}<sha256>, got {entry.filename[:80]!r}")
            if entry.flag_bits & 1 or entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
                raise InvalidError(f"{entry.filename}: encrypted or packed in an unknown way")
        total = sum(entry.file_size for entry in entries)
        if total > max_bytes:
            raise InvalidError(f"archive must unpack to at most {max_bytes} bytes, got {total}")

    def _read(self, name: str, max_bytes: int) -> bytes:
        try:
            # A header may lie about the size: read one byte more than allowed, never all there is.
            with self._zip.open(name) as entry:
                data = entry.read(max_bytes + 1)
        except (
            zipfile.BadZipFile,
            OSError,
            EOFError,
            KeyError,
            ValueError,
            RuntimeError,
            zlib.error,
        ) as error:
            raise InvalidError(f"{name[:80]}: cannot be unpacked: {error}") from error
        if len(data) > max_bytes:
            raise InvalidError(f"{name[:80]}: at most {max_bytes} bytes expected")
        return data

    def _read_index(self) -> Index:
        try:
            return Index.model_validate_json(self._read(INDEX, MAX_INDEX_BYTES))
        except ValidationError as error:
            first = error.errors(include_url=False, include_input=False)[0]
            field = ".".join(str(part) for part in first["loc"])
            raise InvalidError(f"{INDEX}: {field}: {first['msg']}") from error

    def _check_graph(self) -> tuple[Step, ...]:
        steps: list[Step] = [AddStoredNode(place=stored) for stored in self.index.places]
        steps += [PutEdge(edge=edge) for edge in self.index.edges]
        steps += [PutPlace(place=place) for place in self.index.named_places]
        steps += [PutRule(rule=rule) for rule in self.index.rules]
        steps += [PutRoute(route=route) for route in self.index.routes]
        steps += [PutSign(sign=sign) for sign in self.index.signs]
        for what in (self.index.named_places, self.index.rules, self.index.routes, self.index.signs):
            if len({key_of(mark.name) for mark in what}) != len(what):
                raise InvalidError(f"{INDEX}: a name stands there twice")
        if len({(edge.a, edge.b) for edge in self.index.edges}) != len(self.index.edges):
            raise InvalidError(f"{INDEX}: an edge stands there twice")
        try:
            apply(Graph(), steps)
        except MapError as error:
            raise InvalidError(f"{INDEX}: {error}") from error
        return tuple(steps)

    def _check_blobs(self) -> None:
        features = self._features
        thumbnails = {node.thumbnail for node in self.index.places if node.thumbnail}
        stored = {name.removeprefix(BLOBS) for name in self._zip.namelist() if name != INDEX}
        if stored != features | thumbnails:
            missing, extra = len((features | thumbnails) - stored), len(stored - features - thumbnails)
            raise InvalidError(
                f"archive must hold exactly the named blobs: {missing} missing, {extra} too many"
            )
        for sha256 in sorted(stored):
            data = self.blob(sha256)
            try:
                if sha256 in features:
                    unpack_features(data)
            except CorruptError as error:
                raise InvalidError(f"{BLOBS}{sha256[:12]}: {error}") from error


def _is_blob_name(name: str) -> bool:
    digits = name.removeprefix(BLOBS)
    return name.startswith(BLOBS) and len(digits) == 64 and set(digits) <= set("0123456789abcdef")
