"""ROS 2 through rclpy, whatever its middleware: a process in ROS's own interpreter, bytes to and fro."""

import logging
import os
import socket
import subprocess
import threading
import time
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from services.ros.side_car.node import frame_bytes, read_frame
from services.ros.wires.wire import REPORT, SENSOR, Answer, Deliver, Endpoint, Put, Quality, WireError

log = logging.getLogger(__name__)

PROGRAM = Path(__file__).with_name("node.py")
START_S = 30.0
"""Longest start of rclpy; chosen: ten times that of an idle machine."""
END_S = 2.0
"""For the last words to leave, and then for the side-car to end; chosen: longer than it waits itself."""
MOST_WAITING = 64
"""Frames that may wait while the other process stands still; chosen: what is older is worthless by then."""


class Outbox:
    """Sends frames in a thread of its own: who publishes never waits for a process that stands still."""

    def __init__(self, stream: socket.socket) -> None:
        self._stream, self._waiting = stream, deque[tuple[float, bytes]]()
        self._changed, self._closing = threading.Condition(), False
        self._thread = threading.Thread(target=self._run, name="to-rclpy", daemon=True)
        self._thread.start()

    def send(self, header: Mapping[str, Any], payload: bytes = b"", until_s: float = float("inf")) -> None:
        """Send soon; not at all after `until_s`, monotonic, or where too much waits."""
        with self._changed:
            if len(self._waiting) < MOST_WAITING or until_s == float("inf"):
                self._waiting.append((until_s, frame_bytes(dict(header), payload)))
                self._changed.notify()

    def close(self, within_s: float) -> None:
        """Send what waits, if the other process takes it within that time, and end the stream."""
        with self._changed:
            self._closing = True
            self._changed.notify()
        self._thread.join(within_s)
        with suppress(OSError):  # the side-car may be gone
            self._stream.shutdown(socket.SHUT_WR)
        self._thread.join()

    def _run(self) -> None:
        while True:
            with self._changed:
                while not self._waiting and not self._closing:
                    self._changed.wait()
                if not self._waiting:
                    return
                until_s, frame = self._waiting.popleft()
            if time.monotonic() > until_s:
                continue
            try:
                self._stream.sendall(frame)
            except OSError:
                return


class SideCarWire:
    """See `Wire`; the side-car ends with it, and it is down once the side-car is."""

    def __init__(self, process: subprocess.Popen[bytes], stream: socket.socket) -> None:
        self._process, self._stream = process, stream
        self._outbox = Outbox(stream)
        self._deliver: dict[str, Deliver] = {}
        self._answers: dict[str, Answer] = {}
        self._graph: dict[str, dict[str, list[Endpoint]]] = {"MP": {}, "MS": {}}
        self._watched: set[str] = set()
        self._down = ""
        self._closing = False
        self._ready = threading.Event()
        self._thread = threading.Thread(target=self._read, name="from-rclpy", daemon=True)
        self._thread.start()

    def wait_ready(self) -> None:
        """Wait until the node is in the graph.

        Raises:
            WireError: it never is.
        """
        if not self._ready.wait(START_S):
            self._down = f"rclpy did not start within {START_S:.0f} s"
        self.require_up()

    def subscribe(self, topic: str, kind: str, deliver: Deliver, quality: Quality = SENSOR) -> None:
        """See `Wire`."""
        self._deliver[topic] = deliver
        self._declare("subscribe", topic, kind, quality)

    def publisher(self, topic: str, kind: str, quality: Quality = REPORT) -> Put:
        """See `Wire`."""
        self._declare("advertise", topic, kind, quality)

        def put(payload: bytes, lives_s: float | None = None) -> None:
            until_s = time.monotonic() + (quality.lives_s if lives_s is None else lives_s)
            self._outbox.send({"do": "publish", "topic": topic, "until": until_s}, payload, until_s)

        return put

    def serve(self, service: str, kind: str, answer: Answer) -> None:
        """See `Wire`."""
        self._answers[service] = answer
        self._declare("serve", service, kind, REPORT)

    def publishers(self, topic: str) -> list[Endpoint]:
        """See `Wire`."""
        return self._others("MP", topic)

    def subscribers(self, topic: str) -> list[Endpoint]:
        """See `Wire`."""
        return self._others("MS", topic)

    def require_up(self) -> None:
        """See `Wire`."""
        if self._down:
            raise WireError(self._down)

    def close(self) -> None:
        """See `Wire`."""
        if self._closing:
            return
        self._closing = True
        self._outbox.close(END_S)
        try:
            self._process.wait(END_S)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._thread.join()
        self._stream.close()

    def _others(self, role: str, topic: str) -> list[Endpoint]:
        """Who is there as far as the side-car has told, which it does of topics that were asked for."""
        if topic not in self._watched:
            self._watched.add(topic)
            self._outbox.send({"do": "watch", "topic": topic})
        return self._graph[role].get(topic, [])

    def _declare(self, what: str, topic: str, kind: str, quality: Quality) -> None:
        header = {"do": what, "topic": topic, "kind": kind}
        self._outbox.send({**header, "reliable": quality.reliable, "depth": quality.depth})

    def _reply(self, call: int, response: bytes) -> None:
        self._outbox.send({"do": "answer", "call": call}, response)

    def _read(self) -> None:
        while (frame := read_frame(self._stream)) is not None:
            header, payload = frame
            match header["is"]:
                case "message":
                    self._deliver[header["topic"]](payload, float(header["at"]))
                case "graph":
                    self._graph = {role: _endpoints(header[role]) for role in ("MP", "MS")}
                case "call":
                    self._answers[header["service"]](payload, partial(self._reply, header["call"]))
                case "ready":
                    log.info("rclpy is up on %s", header["rmw"])
                    self._ready.set()
                case "fault":
                    log.error("rclpy: %s", header["text"])
                    self._down = header["text"] if header.get("fatal") else self._down
        if not self._closing and not self._down:
            self._down = "the process of rclpy ended"
        self._ready.set()


def _endpoints(told: Mapping[str, list[tuple[str, str]]]) -> dict[str, list[Endpoint]]:
    return {topic: [Endpoint(*one) for one in those] for topic, those in told.items()}


def open_side_car(python: str, setup: Path | None, domain: int, node: str) -> SideCarWire:
    """Start a node in another interpreter.

    Args:
        python: the interpreter that has rclpy.
        setup: a file that the shell reads first, as /opt/ros/jazzy/setup.bash; None for wheels.
        domain: ROS_DOMAIN_ID.
        node: its name.

    Raises:
        WireError: it does not start, or has no rclpy.
    """
    ours, theirs = socket.socketpair()
    command = [python, str(PROGRAM), str(theirs.fileno()), node]
    if setup is not None:
        command = ["bash", "-c", 'source "$0" && exec "$@"', str(setup), *command]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    environment["ROS_DOMAIN_ID"] = str(domain)
    try:
        process = subprocess.Popen(
            command, env=environment, pass_fds=[theirs.fileno()], stdin=subprocess.DEVNULL
        )
    except OSError as error:
        ours.close()
        raise WireError(
            f"{python}: cannot be started ({error.strerror}); ROS2_PYTHON names one with rclpy"
        ) from error
    finally:
        theirs.close()
    wire = SideCarWire(process, ours)
    try:
        wire.wait_ready()
    except WireError:
        wire.close()
        raise
    return wire
