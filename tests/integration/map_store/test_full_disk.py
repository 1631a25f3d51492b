"""A disk that runs full: reads go on, writes are refused whole, and go on once there is room."""

import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

import httpx
import pytest

from shared.bus import Bus, open_bus, wait_until
from shared.messages.maps import MapReply, MapRequest
from shared.queries import RefusedError
from shared.topics import MAP
from tests.faults.lived_maps import place
from tests.integration.gateway.conftest import serve_gateway
from tests.integration.map_store.conftest import START_S, Process

ANSWER_S = 30.0
MOUNT = (
    *("unshare", "-rm", "sh", "-c"),
    'mount -t tmpfs -o size=3m none "$0" && export TMPDIR="$0" && exec "$@"',
)
"""Runs a command with a disk of its own that nobody else sees; what it keeps for a while is there, too."""


class SmallDisk:
    """A map store on a disk of 3 MB, and the room left on it."""

    def __init__(self, process: Process, folder: Path, bus: Bus) -> None:
        assert process.child is not None
        self.rest = httpx.Client(base_url=process.url, trust_env=False, timeout=ANSWER_S)
        self.url = process.url
        self.folder = Path(f"/proc/{process.child.pid}/root{folder}")
        self._ballast = self.folder / "ballast"
        self._bus = bus

    def fill(self) -> None:
        """Take all the room there is."""
        with suppress(OSError), self._ballast.open("wb", buffering=0) as file:
            while True:
                file.write(bytes(4096))

    def clear(self) -> None:
        """Give it back."""
        self._ballast.unlink()

    def ask(self, **fields) -> MapReply:
        """Over the bus."""
        return self._bus.ask(MAP, MapRequest(**fields), ANSWER_S, map="flat")


@pytest.fixture
def disk(
    repository: Path, tmp_path: Path, router_endpoint: str, free_port: Callable[[], int]
) -> Iterator[SmallDisk]:
    """A map store that runs on a small disk."""
    inside = (*MOUNT, str(tmp_path))
    if subprocess.run([*inside, "true"], capture_output=True, check=False).returncode != 0:
        pytest.skip("no disk can be mounted here")
    process = Process(repository, tmp_path, router_endpoint, free_port(), inside, patient=True)
    process.start()
    try:
        with open_bus(router_endpoint) as bus:
            assert wait_until(lambda: bus.alive("map_store") != [], START_S)
            disk = SmallDisk(process, tmp_path, bus)
            with disk.rest:
                yield disk
    finally:
        process.kill()


def write_until_refused(disk: SmallDisk, first: int) -> tuple[int, str]:
    """Add nodes; the number that was refused, and how."""
    for number in range(first, first + 500):
        try:
            disk.ask(action="transact", operations=(place(number, keypoints=200),))
        except RefusedError as error:
            return number, str(error)
    raise AssertionError("the disk never ran full")


def test_a_full_disk_refuses_writes_reads_go_on_and_with_room_writes_do_too(disk: SmallDisk, tmp_path: Path):
    disk.ask(action="create")
    disk.ask(action="transact", operations=(place(0),))
    disk.fill()
    refused, told = write_until_refused(disk, 1)
    assert told.startswith("nothing was written: ")
    assert "full" in told
    assert str(tmp_path) in told
    made = [disk.rest.post("/maps", json={"name": f"map-{number}"}) for number in range(40)]
    answer = next(each for each in made if each.status_code != 201)
    assert (answer.status_code, answer.headers["content-type"]) == (507, "application/problem+json")
    assert answer.json()["type"] == "urn:topnav:problem:storage-full"

    read = disk.ask(action="read")
    assert (read.revision, [node.node_id for node in read.nodes]) == (refused, list(range(refused)))
    assert len(disk.ask(action="read_features").features) == refused
    assert disk.rest.get("/maps/flat/revisions").json()[0]["revision"] == refused
    assert disk.rest.get("/readyz").status_code == 200

    disk.clear()
    assert disk.ask(action="transact", operations=(place(refused),)).revision == refused + 1
    assert disk.rest.post("/maps/flat/undo").json()["undone"] == refused + 1
    assert disk.rest.get("/check").json() == {"damage": []}


@pytest.mark.parametrize("way", ["map store", "gateway"])
def test_an_archive_for_which_there_is_no_room_is_refused_as_such(
    disk: SmallDisk, router_endpoint: str, way: str
):
    disk.ask(action="create")
    disk.ask(action="transact", operations=(place(0),))
    files = set(disk.folder.iterdir())
    for number in range(2):  # the second time the folder for temporary files is known to be full
        with ExitStack() as opened:
            url, path = disk.url, "/maps/import"
            if way == "gateway":
                url, path = opened.enter_context(gateway(router_endpoint, disk.url)), "/api/maps/import"
            sent = (bytes(1_000_000) for _ in range(40))
            answer = httpx.post(f"{url}{path}", content=sent, trust_env=False, timeout=2 * ANSWER_S)
        assert (number, answer.status_code) == (number, 507), answer.text
        assert answer.json()["type"] == "urn:topnav:problem:storage-full"
        assert "no room for an archive" in answer.json()["detail"]
        disk.fill()
    assert [node.node_id for node in disk.ask(action="read").nodes] == [0]
    disk.clear()
    assert set(disk.folder.iterdir()) == files
    assert [each["name"] for each in disk.rest.get("/maps").json()] == ["flat"]


@contextmanager
def gateway(endpoint: str, store: str) -> Iterator[str]:
    """A gateway in front of that map store."""
    yield from serve_gateway(endpoint, map_store_url=store)
