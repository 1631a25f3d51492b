"""Sign service: new nodes are collected as they come, and read in a thread of its own."""

import logging
import threading
from queue import Empty, Full, Queue

import cv2

from services.signs.keeping import keep
from services.signs.new_nodes import NewNode, NewNodes
from services.signs.reading import Read, signs_in
from services.signs.settings import SignsSettings
from shared.bus import Bus
from shared.frames.decoding import decode_picture
from shared.jpeg import BadPictureError
from shared.messages.maps import AddNode
from shared.queries import QueryError
from shared.topics import FRAME, MAP_DELTA
from shared.wire import WireError

log = logging.getLogger(__name__)

IDLE_S = 0.5
"""How soon it notices that it is to end; whatever arrives wakes it before."""


def run(settings: SignsSettings, read: Read, bus: Bus, stop: threading.Event) -> None:
    """Follow the maps and the robot's frames until `stop` is set."""
    cv2.setNumThreads(settings.threads)
    frames, deltas = bus.subscribe(FRAME, robot=settings.robot), bus.subscribe(MAP_DELTA, map="*")
    new, waiting = NewNodes(settings.frames_kept), Queue[NewNode](settings.nodes_waiting)
    reader = threading.Thread(target=_read_all, args=(settings, read, bus, waiting, stop), name="reader")
    reader.start()
    bus.announce("signs")
    while not stop.is_set():
        bus.wait(IDLE_S)
        while (frame := frames.take()) is not None:
            new.add_frame(frame)
        for delta in deltas.take_all():
            for operation in delta.operations:
                if isinstance(operation, AddNode):
                    new.add_node(delta.map, operation.node)
        for node in new.take():
            _put(waiting, node, bus)
    reader.join()


def _put(waiting: Queue[NewNode], node: NewNode, bus: Bus) -> None:
    """Have a node read; where too many wait, the oldest is left out."""
    while True:
        try:
            waiting.put_nowait(node)
            return
        except Full:
            bus.counters.count("left_out", f"reading is slow, {waiting.maxsize} nodes wait: one is not read")
            waiting.get_nowait()


def _read_all(
    settings: SignsSettings, read: Read, bus: Bus, waiting: Queue[NewNode], stop: threading.Event
) -> None:
    while not stop.is_set():
        try:
            node = waiting.get(timeout=IDLE_S)
        except Empty:
            continue
        try:
            _read_one(settings, read, bus, node)
        except BadPictureError as error:
            bus.counters.count("bad_picture", f"node {node.node_id}: {error}")
        except (QueryError, WireError) as error:
            bus.counters.count("not_kept", f"map {node.map!r}, node {node.node_id}: {error}")


def _read_one(settings: SignsSettings, read: Read, bus: Bus, node: NewNode) -> None:
    found = signs_in(decode_picture(node.frame), decode_picture(node.beside), read, settings.least_confidence)
    if found and keep(bus, node.map, node.node_id, found, settings.map_timeout_s):
        log.info("map %r, node %d: %s", node.map, node.node_id, ", ".join(repr(one.text) for one in found))
