"""topnav's node in ROS 2's own interpreter: carries CDR bytes between rclpy and a socket.

Run as a program with the number of the socket and a name, by a Python that has rclpy. It imports nothing but
rclpy and the standard library: the libraries of ROS and those of topnav never meet in one process. It ends
when the other end of the socket does.

Each way a frame is eight bytes (lengths of what follows, little-endian), a JSON object and a payload. `at` is
monotonic time, which both processes share.
"""

import json
import os
import signal
import socket
import struct
import sys
import threading
import time
from contextlib import suppress
from importlib import import_module
from typing import Any

LENGTHS = struct.Struct("<II")
MOST_BYTES = 64_000_000
"""As wires/wire.py has it; a longer frame is no frame."""
LAST_WORDS_S = 0.5
"""How long what was published last may take to arrive; chosen: many round trips of a radio link."""
GRAPH_PERIOD_S = 0.5
"""How soon a publisher that comes or goes is told of; chosen: before anybody asks why nothing happens."""

Frame = tuple[dict[str, Any], bytes]


def frame_bytes(header: dict[str, Any], payload: bytes = b"") -> bytes:
    """One frame."""
    text = json.dumps(header).encode()
    return LENGTHS.pack(len(text), len(payload)) + text + payload


def read_frame(stream: socket.socket) -> Frame | None:
    """The next frame; None when the other end is gone or sends something else."""
    lengths = _read(stream, LENGTHS.size)
    if lengths is None:
        return None
    text_bytes, payload_bytes = LENGTHS.unpack(lengths)
    if text_bytes + payload_bytes > MOST_BYTES:
        return None
    body = _read(stream, text_bytes + payload_bytes)
    if body is None:
        return None
    return json.loads(body[:text_bytes]), body[text_bytes:]


def _read(stream: socket.socket, count: int) -> bytes | None:
    parts = []
    while count:
        try:
            part = stream.recv(min(count, 1 << 20))
        except OSError:
            return None
        if not part:
            return None
        parts.append(part)
        count -= len(part)
    return b"".join(parts)


class Outlet:
    """Sends frames from any thread."""

    def __init__(self, stream: socket.socket) -> None:
        self._stream, self._lock = stream, threading.Lock()

    def send(self, header: dict[str, Any], payload: bytes = b"") -> None:
        """Send one frame, to nobody where the other end is gone: what it said last is still to be obeyed."""
        with suppress(OSError), self._lock:
            self._stream.sendall(frame_bytes(header, payload))


def type_of(kind: str) -> Any:
    """Class of "sensor_msgs/msg/LaserScan"."""
    package, folder, name = kind.split("/")
    return getattr(import_module(f"{package}.{folder}"), name)


class SideCar:
    """Does what the frames ask for with one rclpy node."""

    def __init__(self, node: Any, outlet: Outlet) -> None:
        self._node, self._outlet = node, outlet
        self._publishers: dict[str, Any] = {}
        self._calls: dict[int, tuple[Any, Any]] = {}
        self._called = 0
        self._topics: set[str] = set()
        self._doings = {
            "watch": self._watch,
            "subscribe": self._subscribe,
            "advertise": self._advertise,
            "publish": self._publish,
            "serve": self._serve,
            "answer": self._answer,
        }

    def do(self, header: dict[str, Any], payload: bytes) -> None:
        """Obey one frame; what fails is told and ends nothing."""
        try:
            self._doings[header["do"]](header, payload)
        except Exception as error:  # noqa: BLE001 - rclpy raises what its middleware likes
            self._outlet.send({"is": "fault", "text": f"{header.get('do')} {header.get('topic')}: {error}"})

    def finish(self) -> None:
        """Wait until whoever hears has what was published last, though not for long."""
        from rclpy.duration import Duration

        end_s = time.monotonic() + LAST_WORDS_S
        for publisher in self._publishers.values():
            publisher.wait_for_all_acked(Duration(seconds=max(end_s - time.monotonic(), 0.0)))

    def tell_graph(self) -> None:
        """Say who else publishes and subscribes to the topics that were asked for."""
        told: dict[str, Any] = {"is": "graph", "MP": {}, "MS": {}}
        for topic in self._topics.copy():
            told["MP"][topic] = self._others(self._node.get_publishers_info_by_topic(topic))
            told["MS"][topic] = self._others(self._node.get_subscriptions_info_by_topic(topic))
        self._outlet.send(told)

    def _others(self, endpoints: Any) -> list[tuple[str, str]]:
        return [(e.node_name, e.topic_type) for e in endpoints if e.node_name != self._node.get_name()]

    def _watch(self, header: dict[str, Any], _payload: bytes) -> None:
        self._topics.add(header["topic"])

    def _subscribe(self, header: dict[str, Any], _payload: bytes) -> None:
        topic, outlet = header["topic"], self._outlet

        def store(payload: bytes) -> None:
            outlet.send({"is": "message", "topic": topic, "at": time.monotonic()}, payload)

        self._node.create_subscription(type_of(header["kind"]), topic, store, _quality(header), raw=True)

    def _advertise(self, header: dict[str, Any], _payload: bytes) -> None:
        topic = header["topic"]
        self._publishers[topic] = self._node.create_publisher(
            type_of(header["kind"]), topic, _quality(header)
        )

    def _publish(self, header: dict[str, Any], payload: bytes) -> None:
        """What was held up on its way here is not said any more."""
        if time.monotonic() < header["until"]:
            self._publishers[header["topic"]].publish(payload)

    def _serve(self, header: dict[str, Any], _payload: bytes) -> None:
        from rclpy.serialization import serialize_message
        from rclpy.task import Future

        service = header["topic"]

        async def called(request: Any, response: Any) -> Any:
            self._called += 1
            future = Future()
            self._calls[self._called] = future, type(response)
            self._outlet.send(
                {"is": "call", "service": service, "call": self._called}, serialize_message(request)
            )
            return await future

        self._node.create_service(type_of(header["kind"]), service, called)

    def _answer(self, header: dict[str, Any], payload: bytes) -> None:
        from rclpy.serialization import deserialize_message

        future, kind = self._calls.pop(header["call"])
        future.set_result(deserialize_message(payload, kind))


def _quality(header: dict[str, Any]) -> Any:
    from rclpy.qos import QoSProfile, ReliabilityPolicy

    reliable = ReliabilityPolicy.RELIABLE if header["reliable"] else ReliabilityPolicy.BEST_EFFORT
    return QoSProfile(depth=header["depth"], reliability=reliable)


def _obey(stream: socket.socket, side_car: SideCar, executor: Any) -> None:
    """Read frames until the other end is gone, then end the process: nothing of it outlives topnav."""
    while (frame := read_frame(stream)) is not None:
        side_car.do(*frame)
        executor.wake()
    try:
        side_car.finish()
    finally:
        os._exit(0)


def main() -> None:
    """Run until the other end of the socket is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl+C in a terminal reaches us too: topnav ends us
    stream = socket.socket(fileno=int(sys.argv[1]))
    outlet = Outlet(stream)
    try:
        import rclpy
        from rclpy.executors import SingleThreadedExecutor
        from rclpy.signals import SignalHandlerOptions
    except ImportError as error:
        outlet.send({"is": "fault", "fatal": True, "text": f"{sys.executable} has no rclpy: {error}"})
        return
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = rclpy.create_node(sys.argv[2])
    side_car, executor = SideCar(node, outlet), SingleThreadedExecutor()
    executor.add_node(node)
    node.create_timer(GRAPH_PERIOD_S, side_car.tell_graph)
    outlet.send({"is": "ready", "rmw": rclpy.get_rmw_implementation_identifier()})
    threading.Thread(target=_obey, args=(stream, side_car, executor), daemon=True).start()
    executor.spin()


if __name__ == "__main__":
    main()
