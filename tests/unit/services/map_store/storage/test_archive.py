"""A map as one file: there and back, the same bytes every time, and archives that were made to hurt."""

import io
import json
import struct
import time
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from services.map_store.errors import InvalidError
from services.map_store.storage.archive import Archive
from services.map_store.storage.blobs import checksum
from services.map_store.storage.database import Database
from services.map_store.store import MapStore
from shared.messages.maps import Edge, PutEdge
from tests.traced_memory import TracedCall
from tests.unit.services.map_store.conftest import add, app_of

Entries = dict[str, bytes]


@pytest.fixture
def client(store: MapStore) -> TestClient:
    """REST over a map with three nodes and an edge."""
    store.transact("flat", [add(0), add(1), add(2), PutEdge(edge=Edge(a=0, b=1, heading_ab_rad=0.1))])
    return TestClient(app_of(store, max_archive_bytes=2_000_000))


@pytest.fixture
def exported(client: TestClient) -> bytes:
    """The archive of that map."""
    return client.get("/maps/flat/export").content


def imported(folder: Path, archive: bytes) -> int:
    """HTTP status of the import of `archive` into an empty store in `folder`."""
    database = Database(f"sqlite:///{folder}/empty.sqlite3")
    app = app_of(MapStore(database, lambda: 1, lambda _delta: None), max_archive_bytes=2_000_000)
    try:
        return TestClient(app).post("/maps/import?name=copy", content=archive).status_code
    finally:
        database.close()


def entries_of(data: bytes) -> Entries:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def zipped(entries: Entries, packing: int = zipfile.ZIP_STORED) -> bytes:
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w", packing) as archive:
        for name, data in entries.items():
            archive.writestr(name, data)
    return file.getvalue()


def test_import_gives_the_same_map_under_another_name(client: TestClient, store: MapStore, exported: bytes):
    made = client.post("/maps/import", params={"name": "copy"}, content=exported)
    assert made.status_code == 201
    assert made.json()["nodes"] == 3
    assert dict(store.graph("copy")[1].nodes) == dict(store.graph("flat")[1].nodes)
    assert dict(store.graph("copy")[1].edges) == dict(store.graph("flat")[1].edges)
    assert (
        client.get("/maps/copy/nodes/2/thumbnail").content
        == client.get("/maps/flat/nodes/2/thumbnail").content
    )
    assert len(store.contents.features("copy", [])[1]) == 3


def test_the_same_map_gives_the_same_bytes(client: TestClient, store: MapStore, exported: bytes):
    assert client.get("/maps/flat/export").content == exported
    store.delete("flat")
    assert client.post("/maps/import", content=exported).status_code == 201
    again = client.get("/maps/flat/export")
    assert again.content == exported
    assert again.headers["content-disposition"] == 'attachment; filename="flat.zip"'


def test_import_over_an_existing_map_conflicts(client: TestClient, exported: bytes):
    assert client.post("/maps/import", content=exported).status_code == 409


def test_entries_are_one_index_and_blobs_named_by_their_checksum(exported: bytes):
    entries = entries_of(exported)
    assert json.loads(entries.pop("map.json"))["format"] == "topnav-map.v1"
    assert len(entries) == 6
    assert all(name == f"blobs/{checksum(data)}" for name, data in entries.items())


def test_a_packed_archive_is_taken_too(client: TestClient, exported: bytes):
    packed = zipped(entries_of(exported), zipfile.ZIP_DEFLATED)
    assert client.post("/maps/import?name=copy", content=packed).status_code == 201


def index_with(change: Callable[[dict[str, Any]], None]) -> Callable[[Entries], Entries]:
    def damaged(entries: Entries) -> Entries:
        index = json.loads(entries["map.json"])
        change(index)
        return entries | {"map.json": json.dumps(index).encode()}

    return damaged


def a_blob(entries: Entries) -> str:
    return next(name for name in entries if name != "map.json")


def without_a_blob(entries: Entries) -> Entries:
    return {name: data for name, data in entries.items() if name != a_blob(entries)}


def edge(a: int, b: int) -> dict[str, int]:
    return {"a": a, "b": b}


DAMAGE: dict[str, tuple[Callable[[Entries], Entries], str]] = {
    "path traversal": (lambda e: e | {"../evil": b""}, "entry must be"),
    "absolute path": (lambda e: e | {"/etc/passwd": b""}, "entry must be"),
    "traversal below blobs": (lambda e: e | {"blobs/../../x": b""}, "entry must be"),
    "windows path": (lambda e: e | {"blobs\\..\\x": b""}, "entry must be"),
    "folder": (lambda e: e | {"blobs/": b""}, "entry must be"),
    "short checksum": (lambda e: e | {"blobs/abc": b""}, "entry must be"),
    "no index": (lambda e: {n: d for n, d in e.items() if n != "map.json"}, "must hold map.json"),
    "index no JSON": (lambda e: e | {"map.json": b"{"}, "map.json"),
    "index deeply nested": (lambda e: e | {"map.json": b"[" * 100_000}, "map.json"),
    "index a pickle": (lambda e: e | {"map.json": b"\x80\x04N."}, "map.json"),
    "another format": (index_with(lambda i: i.update(format="topnav-map.v9")), "format"),
    "bad name": (index_with(lambda i: i.update(name="../x")), "name"),
    "NaN heading": (
        index_with(lambda i: i["edges"][0].update(heading_ab_rad=float("nan"))),
        "heading_ab_rad",
    ),
    "node twice": (index_with(lambda i: i["places"].append(i["places"][0])), "node 0 exists already"),
    "edge to nowhere": (index_with(lambda i: i["edges"].append(edge(1, 9))), "node 9 does not exist"),
    "edge twice": (index_with(lambda i: i["edges"].append(edge(0, 1))), "twice"),
    "edge backwards": (index_with(lambda i: i["edges"].append(edge(2, 1))), "a < b"),
    "blob missing": (without_a_blob, "1 missing"),
    "blob too many": (lambda e: e | {f"blobs/{checksum(b'x')}": b"x"}, "1 too many"),
    "blob damaged": (lambda e: e | {a_blob(e): b"other"}, "checksum"),
    "unpacks to too much": (
        lambda e: e | {f"blobs/{checksum(bytes(3_000_000))}": bytes(3_000_000)},
        "at most 2000000",
    ),
}


@pytest.mark.parametrize("kind", DAMAGE)
def test_damaged_archives_are_refused_before_anything_is_written(
    client: TestClient, store: MapStore, exported: bytes, kind: str
):
    change, told = DAMAGE[kind]
    bad = zipped(change(entries_of(exported)), zipfile.ZIP_DEFLATED)
    response = client.post("/maps/import?name=copy", content=bad)
    assert response.status_code == 422
    assert told in response.json()["detail"]
    assert [summary.name for summary in store.summaries()] == ["flat"]


def test_features_that_are_none_are_refused(client: TestClient, exported: bytes):
    entries = entries_of(exported)
    index = json.loads(entries["map.json"])
    old, new = index["places"][0]["features"], checksum(b"junk")
    index["places"][0]["features"] = new
    del entries[f"blobs/{old}"]
    entries |= {f"blobs/{new}": b"junk", "map.json": json.dumps(index).encode()}
    response = client.post("/maps/import?name=copy", content=zipped(entries))
    assert response.status_code == 422
    assert "stored features" in response.json()["detail"]


@pytest.mark.parametrize("data", [b"", b"junk", b"PK\x05\x06" + bytes(18), b"PK\x03\x04" + bytes(100)])
def test_anything_but_a_zip_is_refused(client: TestClient, data: bytes):
    assert client.post("/maps/import", content=data).status_code == 422


def test_an_entry_of_a_later_version_of_zip_is_refused(client: TestClient, exported: bytes):
    at = exported.rindex(b"PK\x01\x02")
    response = client.post(
        "/maps/import?name=copy", content=exported[: at + 6] + b"\xff" + exported[at + 7 :]
    )
    assert response.status_code == 422
    assert "not a zip archive" in response.json()["detail"]


def test_a_directory_of_very_many_entries_is_refused_unread():
    entry = struct.pack("<4s6H3I5H2I", b"PK\1\2", 20, 20, *[0] * 7, 70, *[0] * 6) + b"blobs/" + b"0" * 64
    directory = entry * 100_000
    end = struct.pack("<4s4H2IH", b"PK\5\6", 0, 0, 0xFFFF, 0xFFFF, len(directory), 0, 0)
    file = io.BytesIO(directory + end)
    began_s = time.thread_time()
    with pytest.raises(InvalidError, match="directory must have at most 10000000 bytes"):
        Archive(file, 2_000_000)
    assert time.thread_time() - began_s < 0.1


@pytest.mark.parametrize("packing", [zipfile.ZIP_DEFLATED, zipfile.ZIP_LZMA, zipfile.ZIP_BZIP2])
def test_an_entry_that_unpacks_to_more_than_it_says_is_refused(
    exported: bytes, packing: int, tmp_path: Path, traced_call: TracedCall
):
    """A bomb whose header lies about its size: at most what was announced is ever unpacked."""
    name = f"blobs/{checksum(bytes(100_000_000))}"
    bomb = bytearray(zipped(entries_of(exported) | {name: bytes(100_000_000)}, packing))
    at = bomb.rindex(b"PK\x01\x02")
    bomb[at + 24 : at + 28] = struct.pack("<I", 1_000)
    assert traced_call(imported, tmp_path, exported)[0] == 201
    status, peak_bytes = traced_call(imported, tmp_path, bytes(bomb))
    assert status == 422
    assert peak_bytes < 20_000_000


@pytest.mark.parametrize("mode", [0o120777, 0o060644, 0o010644], ids=["link", "device", "pipe"])
def test_links_and_devices_are_never_made(client: TestClient, exported: bytes, mode: int, tmp_path: Path):
    """Entries are read, never written out; the name of a link breaks the rule of names anyway."""
    file = io.BytesIO(exported)
    with zipfile.ZipFile(file, "a") as archive:
        entry = zipfile.ZipInfo("blobs/link")
        entry.external_attr = mode << 16
        archive.writestr(entry, "/etc/passwd")
    before = sorted(tmp_path.rglob("*"))
    response = client.post("/maps/import?name=copy", content=file.getvalue())
    assert response.status_code == 422
    assert "entry must be" in response.json()["detail"]
    assert [path for path in sorted(tmp_path.rglob("*")) if path not in before] == []


def test_every_truncated_archive_is_refused(client: TestClient, exported: bytes):
    for length in range(0, len(exported), 97):
        assert client.post("/maps/import?name=copy", content=exported[:length]).status_code == 422


def test_a_damaged_byte_anywhere_is_refused_or_changes_nothing_that_counts(
    client: TestClient, exported: bytes
):
    for place in range(0, len(exported), 61):
        bad = bytearray(exported)
        bad[place] ^= 0xFF
        response = client.post("/maps/import?name=copy", content=bytes(bad))
        assert response.status_code in {201, 422}
        if response.status_code == 201:
            assert client.get("/maps/copy/nodes").json() == client.get("/maps/flat/nodes").json()
            client.delete("/maps/copy")


def test_an_archive_longer_than_allowed_is_refused(client: TestClient):
    for content in (bytes(2_000_001), iter([bytes(1_000_000)] * 3)):
        response = client.post("/maps/import", content=content)
        assert response.status_code == 413
        assert "at most 2000000 bytes" in response.json()["detail"]


@pytest.mark.parametrize("length", [200_001, 1_500_000])
def test_thumbnails_are_no_longer_than_the_bus_carries(client: TestClient, exported: bytes, length: int):
    """24 of 60 MB each, packed into 6 MB, held up a mission for a minute and a half."""
    entries = entries_of(exported)
    index, picture = json.loads(entries["map.json"]), bytes(length)
    old, index["places"][0]["thumbnail"] = index["places"][0]["thumbnail"], checksum(picture)
    entries |= {"map.json": json.dumps(index).encode(), f"blobs/{checksum(picture)}": picture}
    if old not in json.dumps(index):
        del entries[f"blobs/{old}"]
    refused = client.post("/maps/import?name=copy", content=zipped(entries, zipfile.ZIP_DEFLATED))
    assert refused.status_code == 422
    assert "at most 200000 bytes expected" in refused.json()["detail"]
    assert [entry["name"] for entry in client.get("/maps").json()] == ["flat"]


def test_an_archive_unpacks_to_a_few_times_its_length(exported: bytes):
    packed = zipped(entries_of(exported) | {"blobs/" + "0" * 64: bytes(20_000_000)}, zipfile.ZIP_DEFLATED)
    with pytest.raises(InvalidError, match="must unpack to at most 16000000 bytes"):
        Archive(io.BytesIO(packed), 10**9)
