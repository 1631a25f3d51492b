"""ROS 2 over a Zenoh session of our own, as a client of the robot's router; no ROS is installed here."""

import itertools
import logging
import threading
import time
from collections import defaultdict
from collections.abc import Callable
from typing import Any

import zenoh

from services.ros.wires.bridge import BridgeNames
from services.ros.wires.rmw_zenoh import RmwZenohNames
from services.ros.wires.wire import (
    MOST_BYTES,
    REPORT,
    SENSOR,
    URGENT,
    Answer,
    Deliver,
    Endpoint,
    Put,
    Quality,
    WireError,
)
from shared.transport.session_config import session_config

log = logging.getLogger(__name__)

Names = RmwZenohNames | BridgeNames
CONNECT_MS = 2_000
"""How long one try to reach the router may take; chosen: the service tries again."""


class Graph:
    """Who publishes, subscribes and serves what, from liveliness tokens; read from any thread."""

    def __init__(self, names: Names) -> None:
        self._names = names
        self._there: dict[tuple[str, str], dict[str, Endpoint]] = defaultdict(dict)
        self._lock = threading.Lock()

    def store(self, sample: zenoh.Sample) -> None:
        """Note that a token came or went. Called on Zenoh's thread."""
        key = str(sample.key_expr)
        read = self._names.read_token(key)
        if read is None:
            return
        role, topic, endpoint = read
        with self._lock:
            if sample.kind == zenoh.SampleKind.PUT:
                self._there[role, topic][key] = endpoint
            else:
                self._there[role, topic].pop(key, None)

    def of(self, role: str, topic: str) -> list[Endpoint]:
        """Everybody of that role there now."""
        with self._lock:
            return list(self._there[role, topic].values())


class ZenohWire:
    """The wire of rmw_zenoh or of zenoh-bridge-ros2dds, by its names."""

    def __init__(self, session: zenoh.Session, names: Names) -> None:
        self._session, self._names = session, names
        self._entities = itertools.count(1)
        self._declared: list[Any] = []
        self._graph = Graph(names)
        watch: Any = zenoh.handlers.Callback(self._graph.store, indirect=False)
        tokens = session.liveliness()
        self._declared.append(tokens.declare_subscriber(names.token_filter(), watch, history=True))
        node = names.node_token()
        if node is not None:
            self._declared.append(tokens.declare_token(node))

    def subscribe(self, topic: str, kind: str, deliver: Deliver, quality: Quality = SENSOR) -> None:
        """See `Wire`."""

        def store(sample: zenoh.Sample) -> None:
            if len(sample.payload) <= MOST_BYTES:
                deliver(sample.payload.to_bytes(), time.monotonic())

        handler: Any = zenoh.handlers.Callback(store, indirect=False)
        self._declared.append(self._session.declare_subscriber(self._names.heard_key(topic, kind), handler))
        self._announce("MS", topic, kind, quality)

    def publisher(self, topic: str, kind: str, quality: Quality = REPORT) -> Put:
        """See `Wire`: a session holds nothing up, so nothing is too late."""
        urgent = quality == URGENT
        publisher = self._session.declare_publisher(
            self._names.data_key(topic, kind),
            priority=zenoh.Priority.REAL_TIME if urgent else zenoh.Priority.DATA,
            express=urgent,
            congestion_control=zenoh.CongestionControl.DROP,
        )
        self._declared.append(publisher)
        gid = self._names.gid(self._announce("MP", topic, kind, quality))
        numbers = itertools.count(1)

        def put(payload: bytes, _lives_s: float | None = None) -> None:
            publisher.put(payload, attachment=self._names.attachment(next(numbers), time.time_ns(), gid))

        return put

    def serve(self, service: str, kind: str, answer: Answer) -> None:
        """See `Wire`."""
        key = self._names.data_key(service, kind)

        def store(query: zenoh.Query) -> None:
            asked = None if query.attachment is None else query.attachment.to_bytes()
            if self._names.answers_need_attachment and self._names.answer_attachment(asked, 0) is None:
                log.warning("%s: a request without the attachment of rmw_zenoh is not answered", service)
                return
            request = query.payload.to_bytes() if query.payload is not None else b""

            def reply(response: bytes) -> None:
                with query:
                    query.reply(
                        key, response, attachment=self._names.answer_attachment(asked, time.time_ns())
                    )

            answer(request, reply)

        self._declared.append(self._session.declare_queryable(key, store, complete=True))
        self._announce("SS", service, kind, REPORT)

    def publishers(self, topic: str) -> list[Endpoint]:
        """See `Wire`."""
        return self._graph.of("MP", topic)

    def subscribers(self, topic: str) -> list[Endpoint]:
        """See `Wire`."""
        return self._graph.of("MS", topic)

    def require_up(self) -> None:
        """See `Wire`: a session looks for its router by itself, and topics that went silent are named."""

    def close(self) -> None:
        """See `Wire`."""
        try:
            for declared in reversed(self._declared):
                declared.undeclare()
        finally:
            self._declared.clear()
            self._session.close()  # type: ignore[no-untyped-call]

    def _announce(self, role: str, topic: str, kind: str, quality: Quality) -> str:
        token = self._names.token(next(self._entities), role, topic, kind, quality)
        self._declared.append(self._session.liveliness().declare_token(token))
        return token


def open_zenoh(endpoint: str, names: Callable[[str], Names]) -> ZenohWire:
    """Join the router at `endpoint` as a client: peers of rmw_zenoh would not tell us of each other.

    Args:
        endpoint: of `rmw_zenohd` or the bridge, "tcp/192.168.1.2:7447".
        names: makes the names for a session's id.

    Raises:
        WireError: nobody is there.
    """
    config = session_config("client", [], [endpoint], {"connect/timeout_ms": CONNECT_MS})
    try:
        session = zenoh.open(config)
    except zenoh.ZError as error:
        raise WireError(
            f"no Zenoh router of the robot at {endpoint}: is rmw_zenohd or the bridge up? {str(error)[:160]}"
        ) from error
    return ZenohWire(session, names(str(session.info.zid())))
