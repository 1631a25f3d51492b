"""The sign service on a real bus: a new node's frame is read and kept in the map while others write."""

import threading
from collections.abc import Iterator

import numpy as np
import pytest
import zenoh

from services.launcher.processes.free_ports import free_ports
from services.signs.keeping import keep
from services.signs.reading import Reading
from services.signs.recognition import Line
from services.signs.service import run
from services.signs.settings import SignsSettings
from shared.bus import Bus, open_bus, wait_until
from shared.messages.maps import AddNode, MapDelta, MapReply, MapRequest, Node
from shared.messages.places import PutSign, Sign
from shared.messages.sensors import Frame
from shared.topics import FRAME, MAP, MAP_DELTA
from shared.transport.router_config import router_config
from tests.contract.samples import features

WAIT_S = 30.0
WIDTH, HEIGHT = 512, 256


class StandInStore:
    """A map at revision 7 that somebody else writes to once, between reading and writing."""

    def __init__(self, bus: Bus) -> None:
        self.revision, self.signs, self.refused = 7, dict[str, Sign](), 0
        self._bus, self._requests = bus, bus.requests(MAP, map="*")
        self.deltas = bus.publisher(MAP_DELTA, map="flat")

    def serve(self, stop: threading.Event) -> None:
        while not stop.is_set():
            self._bus.wait(0.05)
            while (request := self._requests.take()) is not None:
                asked: MapRequest = request.message
                if asked.action == "transact" and asked.base_revision != self.revision:
                    self.refused += 1
                    request.refuse("another revision", "conflict")
                    continue
                for operation in asked.operations:
                    assert isinstance(operation, PutSign)
                    self.signs[operation.sign.name] = operation.sign
                node, signs = Node(node_id=4), tuple(self.signs.values())
                request.reply(MapReply(map="flat", revision=self.revision, nodes=(node,), signs=signs))
                if asked.action == "read" and not self.refused:
                    self.revision += 1  # somebody else came first


def frame(seq: int) -> Frame:
    """Grey, with a red plate left of ahead."""
    picture = np.full((HEIGHT, WIDTH, 3), 90, np.uint8)
    picture[90:100, 180:200] = (0, 0, 255)
    size = {"width_px": WIDTH, "height_px": HEIGHT}
    return Frame(seq=seq, stamp_ns=seq, robot="r1", encoding="bgr8", data=picture.tobytes(), **size)


def read(picture: np.ndarray) -> list[Line]:
    """Reads red as one line."""
    rows, columns = np.nonzero((picture[..., 2] > 170) & (picture[..., 0] < 60))
    if not len(rows):
        return []
    (u0, u1), (v0, v1) = (columns.min(), columns.max() + 1), (rows.min(), rows.max() + 1)
    return [Line("214", 0.99, np.array([(u0, v0), (u1, v0), (u1, v1), (u0, v1)], float))]


@pytest.fixture
def buses() -> Iterator[tuple[Bus, Bus]]:
    """A session of the service, and one of everybody else."""
    address = f"tcp/127.0.0.1:{free_ports(1)[0]}"
    with zenoh.open(router_config(address)), open_bus(address) as own, open_bus(address) as others:
        yield own, others


def test_the_sign_at_a_new_node_becomes_part_of_the_map(buses: tuple[Bus, Bus]) -> None:
    own, others = buses
    store, stop = StandInStore(others), threading.Event()
    threads = [
        threading.Thread(target=store.serve, args=(stop,)),
        threading.Thread(target=run, args=(SignsSettings(), read, own, stop)),
    ]
    for thread in threads:
        thread.start()
    try:
        assert wait_until(lambda: "signs" in others.alive(), WAIT_S)
        frames = others.publisher(FRAME, robot="r1")
        new = AddNode(node=Node(node_id=4, frame_seq=2, stamp_ns=2), features=features())

        def told() -> bool:  # a peer that was just found may miss the first samples
            for seq in (1, 2):
                frames.put(frame(seq))
                others.wait(0.1)
            store.deltas.put(MapDelta(map="flat", revision=8, operations=(new,)))
            return wait_until(lambda: bool(store.signs), 2.0)

        assert wait_until(told, WAIT_S)
    finally:
        stop.set()
        for thread in threads:
            thread.join()
    (sighting,) = store.signs["214"].sightings
    assert (sighting.node, store.refused) == (4, 1)
    assert sighting.bearing_rad == pytest.approx(2 * np.pi * (256 - 190) / WIDTH, abs=0.02)


def test_a_write_that_somebody_else_came_before_is_made_again_on_top_of_theirs(
    buses: tuple[Bus, Bus],
) -> None:
    own, others = buses
    store, stop = StandInStore(others), threading.Event()
    thread = threading.Thread(target=store.serve, args=(stop,))
    thread.start()
    try:
        reading = Reading("214", 0.99, (1.0, 0.0, 0.0), 0.1)
        assert keep(own, "flat", 4, [reading], WAIT_S)
        assert not keep(own, "flat", 5, [reading], WAIT_S), "a node that is gone meanwhile"
    finally:
        stop.set()
        thread.join()
    assert (store.refused, [one.node for one in store.signs["214"].sightings]) == (1, [4])
