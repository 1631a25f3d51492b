"""Map archives, as they are and with their index damaged."""

import io
import json
import struct
import zipfile
import zlib
from pathlib import Path
from typing import Any

import numpy as np

from services.map_store.errors import InvalidError
from services.map_store.storage.archive import INDEX, Archive, write_archive
from services.map_store.storage.blobs import checksum, pack_features
from services.map_store.storage.contents import Kind
from services.map_store.storage.graph import AddStoredNode, Graph, StoredNode, apply
from shared.messages.features import Features
from shared.messages.maps import Edge, Node, PutEdge
from tests.fuzz.decoder import Decoder, Shape

MAX_BYTES = 2_000_000
TOKENS = (
    b"PK\x03\x04",
    b"PK\x01\x02",
    b"PK\x05\x06",
    b"PK\x06\x06",
    b"map.json",
    b"../",
    b"blobs/",
    b"\xff" * 8,
)


def decoders(_scratch: Path) -> list[Decoder]:
    """The one reader of archives."""
    good = archive()
    with zipfile.ZipFile(io.BytesIO(good)) as entries:
        packed = zipped({name: entries.read(name) for name in entries.namelist()})
    shape = Shape(unzipped, zipped)
    return [Decoder("archives/map", _read, (InvalidError,), (good, packed), TOKENS, shape, memory_mb=32)]


def archive() -> bytes:
    """A map of three places and two edges."""
    blobs: dict[str, bytes] = {}
    graph = Graph()
    for number in range(3):
        drawn = np.random.default_rng(number)
        features = Features(
            pipeline="sift",
            lonlat_rad=drawn.random((4, 2), dtype=np.float32),
            scores=drawn.random(4, dtype=np.float32),
            descriptors=drawn.random((4, 8), dtype=np.float32),
        )
        thumbnail = b"\xff\xd8 picture %d" % number
        node = Node(node_id=number, stamp_ns=number + 1, pipeline="sift", keypoints=4)
        packed = pack_features(features)
        place = StoredNode(node=node, features=checksum(packed), thumbnail=checksum(thumbnail))
        blobs |= {place.features: packed, place.thumbnail: thumbnail}
        graph = apply(graph, [AddStoredNode(place=place)]).graph
    graph = apply(graph, [PutEdge(edge=Edge(a=a, b=a + 1, raw_matches=60, inliers=40)) for a in (0, 1)]).graph

    def read(place: StoredNode, kind: Kind) -> bytes:
        return blobs[place.features if kind == "features" else place.thumbnail]

    file = io.BytesIO()
    write_archive(file, "flat", 7, graph, read)
    return file.getvalue()


def unzipped(data: bytes) -> Any:
    """Archive -> {name: content}, its index as a tree."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as entries:
            contents: dict[str, Any] = {name: entries.read(name)[:MAX_BYTES] for name in entries.namelist()}
        return contents | {INDEX: json.loads(contents[INDEX])}
    except (zipfile.BadZipFile, OSError, EOFError, KeyError, RuntimeError, zlib.error, struct.error) as error:
        raise ValueError(str(error)) from error


def zipped(tree: Any) -> bytes:
    """{name: content} -> archive, packed."""
    if not isinstance(tree, dict):
        raise ValueError("no entries")
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as entries:
        for name, content in tree.items():
            entries.writestr(name, content if isinstance(content, bytes) else json.dumps(content))
    return file.getvalue()


def _read(data: bytes) -> None:
    found = Archive(io.BytesIO(data), MAX_BYTES)
    assert all(found.blob(place.features) for place in found.index.places)
