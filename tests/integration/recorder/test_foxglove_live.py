"""The live view as a process on a real bus, seen by a client that speaks Foxglove's protocol."""

import io
import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
import zenoh
from PIL import Image

from services.launcher.processes.free_ports import free_ports
from shared.bus import Bus, Requests, open_bus, wait_until
from shared.messages.drive import Heading
from shared.messages.maps import Edge, MapDelta, MapReply, MapRequest, Node, PutEdge
from shared.messages.missions import MissionStatus
from shared.messages.places import Place
from shared.messages.sensors import Frame, Ranges
from shared.topics import FRAME, HEADING, MAP_DELTA, MAP_READ, RANGES, STATUS
from shared.transport.router_config import router_config
from tests.integration.recorder.foxglove_client import PROTOCOL, FoxgloveClient
from tests.protobuf_fields import fields

SOON_S = 30.0
WIDTH, HEIGHT = 64, 32
FRAMES = 120  # 47 MB: twice what sockets and queue hold
KEY = "topnav/r1"
GRAPH = "topnav/maps/flat/graph"
SCHEMAS = {
    f"{KEY}/frame": "frame.v1",
    f"{KEY}/frame/image": "foxglove.CompressedImage",
    f"{KEY}/ranges": "ranges.v1",
    f"{KEY}/ranges/scan": "foxglove.LaserScan",
    f"{KEY}/heading": "heading.v1",
    f"{KEY}/heading/arrow": "foxglove.SceneUpdate",
    f"{KEY}/status": "mission_status.v1",
}

pytestmark = pytest.mark.usefixtures("patient_sessions")


@dataclass(frozen=True)
class Live:
    """The process, and a bus to speak to it."""

    bus: Bus
    port: int
    endpoint: str
    errors: Path


@pytest.fixture(scope="module")
def live(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Live]:
    router_port, port = free_ports(2)
    endpoint = f"tcp/127.0.0.1:{router_port}"
    errors = tmp_path_factory.mktemp("live") / "errors.jsonl"
    variables = {"TOPNAV_ENDPOINT": endpoint, "FOXGLOVE_LIVE_PORT": str(port)}
    command = [sys.executable, "-m", "tests.patient", "services.recorder.foxglove"]
    with zenoh.open(router_config(endpoint)), open_bus(endpoint) as bus, errors.open("wb") as stream:
        process = subprocess.Popen(command, env=os.environ | variables, stderr=stream)
        try:
            assert wait_until(lambda: "foxglove" in bus.alive(), SOON_S), errors.read_text()
            yield Live(bus, port, endpoint, errors)
        finally:
            process.terminate()
            assert process.wait(SOON_S) == 0


class Robot:
    """Says what a robot says, as often as it is called."""

    def __init__(self, bus: Bus) -> None:
        self._frames, self._ranges = bus.publisher(FRAME, robot="r1"), bus.publisher(RANGES, robot="r1")
        self._headings, self._statuses = (
            bus.publisher(HEADING, robot="r1"),
            bus.publisher(STATUS, robot="r1"),
        )
        picture = np.zeros((HEIGHT, WIDTH, 3), np.uint8)
        picture[..., 0] = 200  # blue
        self._picture = picture.tobytes()

    def __call__(self) -> None:
        picture = {"encoding": "bgr8", "width_px": WIDTH, "height_px": HEIGHT, "data": self._picture}
        self._frames.put(Frame(robot="r1", **picture))
        angles = tuple(float(angle) for angle in np.deg2rad(np.arange(12) * 30.0))
        self._ranges.put(Ranges(robot="r1", angles_rad=angles, distances_m=(1.5,) * 12, max_range_m=4.0))
        self._headings.put(Heading(robot="r1", heading_rad=0.5, action="go"))
        self._statuses.put(MissionStatus(robot="r1", map="flat", state="running", similarity=7))

    def malformed(self) -> None:
        """What is no distances."""
        self._ranges.put_bytes(b"no msgpack")


@pytest.fixture(scope="module")
def robot(live: Live) -> Robot:
    return Robot(live.bus)


@pytest.fixture
def noisy_frame() -> Frame:
    """A frame of some 390 kB, which no JPEG makes smaller."""
    noise = np.random.default_rng(7).integers(0, 255, (512, 1024, 3), dtype=np.uint8)
    jpeg = io.BytesIO()
    Image.fromarray(noise).save(jpeg, "JPEG", quality=75)
    return Frame(robot="loud", encoding="jpeg", width_px=1024, height_px=512, data=jpeg.getvalue())


def hear(client: FoxgloveClient, say: Callable[[], object], *names: str) -> dict[str, bytes]:
    """Listen to channels and say things until something came in each; the newest of each."""
    assert client.until(lambda: (say(), set(names) <= client.channels.keys())[1], SOON_S)
    client.came.clear()
    client.listen(*names)
    assert client.until(lambda: (say(), set(names) <= client.came.keys())[1], SOON_S)
    return {name: client.came[name][-1] for name in names}


def test_a_client_is_told_what_there_is_and_hears_it_while_it_is_said(live, robot):
    with FoxgloveClient(live.port) as client:
        heard = hear(client, robot, *SCHEMAS)
        assert client.subprotocol == PROTOCOL
        assert client.server["name"] == "topnav"
        assert {name: client.channels[name]["schemaName"] for name in SCHEMAS} == SCHEMAS
        picture = Image.open(io.BytesIO(fields(heard[f"{KEY}/frame/image"])[2][0]))
        assert (picture.format, picture.size) == ("JPEG", (WIDTH, HEIGHT))
        red, _, blue = np.asarray(picture).mean(axis=(0, 1))
        assert blue > 150 > 50 > red
        (arrow,) = fields(fields(heard[f"{KEY}/heading/arrow"])[2][0])[7]
        assert fields(arrow)[1], "with a pose"
        assert json.loads(heard[f"{KEY}/status"])["similarity"] == 7


def test_malformed_messages_are_counted_and_what_follows_is_shown(live, robot):
    with FoxgloveClient(live.port) as client:
        hear(client, robot, f"{KEY}/ranges")
        assert client.until(
            lambda: (robot.malformed(), f"malformed: {KEY}/ranges" in live.errors.read_text())[1], SOON_S
        )
        client.came.clear()
        assert client.until(lambda: (robot(), client.came)[1], SOON_S)


def test_whoever_comes_late_sees_how_things_stand_though_nothing_more_is_said(live, robot):
    with FoxgloveClient(live.port) as first:
        hear(first, robot, f"{KEY}/status")
    with FoxgloveClient(live.port) as late:
        (status,) = hear(late, lambda: None, f"{KEY}/status").values()
        assert json.loads(status)["map"] == "flat"


def test_a_client_that_reads_nothing_holds_up_nobody_and_loses_frames(live, noisy_frame):
    """It is sent more than its sockets and its queue hold; meanwhile another one hears frame after frame."""
    frames, image, said = live.bus.publisher(FRAME, robot="loud"), "topnav/loud/frame/image", []

    def say():
        said.append(frames.put(noisy_frame))

    with FoxgloveClient(live.port) as stuck, FoxgloveClient(live.port) as client:
        assert stuck.until(lambda: (say(), image in stuck.channels)[1], SOON_S)
        stuck.listen(image)
        hear(client, say, image)
        said.clear()
        for count in range(1, FRAMES + 1):
            client.came.clear()
            assert client.until(lambda: (say(), client.came)[1], SOON_S), count
        assert not stuck.until(lambda: len(stuck.came.get(image, [])) >= len(said), 0.5)


class Store:
    """Stands in for the map store: three nodes in a row, of which two are joined."""

    def __init__(self, bus: Bus) -> None:
        self._requests: Requests[MapRequest, MapReply] = bus.requests(MAP_READ, map="*")

    def __call__(self) -> None:
        """Answer who asks."""
        while (request := self._requests.take()) is not None:
            nodes = tuple(Node(node_id=k) for k in range(3))
            kitchen = Place(name="kitchen", nodes=(1,))
            request.reply(
                MapReply(map="flat", revision=4, nodes=nodes, edges=(joined(0),), places=(kitchen,))
            )


def joined(a: int) -> Edge:
    """A metre straight ahead, to the next node."""
    return Edge(
        a=a, b=a + 1, inliers=90, confidence=1.0, heading_ab_rad=0.0, heading_ba_rad=np.pi, yaw_ab_rad=0.0,
        length_m=1.0, length_std_m=0.05, traversals=1,
    )  # fmt: skip


def scene(data: bytes) -> tuple[list[float], list[str]]:
    """How far ahead of the first node each node lies, and the texts."""
    (entity,) = fields(data)[2]
    found = fields(entity)
    places = [fields(fields(fields(sphere)[1][0])[1][0]) for sphere in found.get(9, [])]
    return sorted(place.get(1, [0.0])[0] for place in places), [
        fields(text)[6][0].decode() for text in found.get(13, [])
    ]


def test_a_map_is_drawn_once_its_store_is_there_and_follows_what_changes(live, robot):
    with FoxgloveClient(live.port) as client:
        assert client.until(lambda: (robot(), "unread map: flat" in live.errors.read_text())[1], SOON_S)
        assert GRAPH not in client.channels
        with open_bus(live.endpoint) as other:
            store, deltas = Store(other), other.publisher(MAP_DELTA, map="flat")
            (drawn,) = hear(client, store, GRAPH).values()
            ahead_m, texts = scene(drawn)
            assert ahead_m == pytest.approx([0.0, 1.0], abs=0.01)
            assert texts == ["0", "1", "kitchen"]
            deltas.put(MapDelta(map="flat", revision=5, operations=(PutEdge(edge=joined(1)),)))
            assert client.until(lambda: len(scene(client.came[GRAPH][-1])[0]) == 3, SOON_S)
        client.came.clear()
        robot()
        assert client.until(lambda: (robot(), f"{KEY}/ranges" in client.channels)[1], SOON_S), (
            "the store left"
        )
