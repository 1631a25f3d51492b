"""Typed access to Zenoh: publishers, subscribers, questions, liveliness; everything closes with the bus."""

import re
import threading
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any, Generic, TypeVar

import zenoh
from zenoh import ext

from shared import queries
from shared.bus_config import peer_config
from shared.inbox import Counters, Inbox
from shared.messages.base import Message
from shared.queries import Request, Requests
from shared.topics import Delivery, Query, Topic, alive_key
from shared.wire import WireError, encode

M = TypeVar("M", bound=Message)
Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)

CAPACITY = {Delivery.DATA: 1, Delivery.COMMAND: 1, Delivery.LOG: 1024, Delivery.RECOVERED: 4096}
RECOVERY_CACHE = 256
HEARTBEAT_S = 0.5


class Publisher(Generic[M]):
    """Sends messages of one topic."""

    def __init__(self, publisher: Any, topic: Topic[M]) -> None:
        self._publisher, self._topic = publisher, topic

    def put(self, message: M) -> None:
        """Send; returns at once, even when nobody listens.

        Raises:
            WireError: longer than the topic allows; every reader would throw it away.
        """
        self.put_bytes(encode(message))

    def put_bytes(self, payload: bytes) -> None:
        """Send a message that is encoded already.

        Raises:
            WireError: as for `put`.
        """
        if len(payload) > self._topic.max_bytes:
            most = self._topic.max_bytes
            raise WireError(f"{self._topic.template}: at most {most} bytes expected, got {len(payload)}")
        self._publisher.put(payload)


class Bus:
    """One Zenoh session. `wake` is set whenever something arrived, so that a loop can wait on everything."""

    def __init__(self, session: zenoh.Session) -> None:
        self._session = session
        self._declared: list[Any] = []
        self.wake = threading.Event()
        self.counters = Counters()

    def publisher(self, topic: Topic[M], **names: str) -> Publisher[M]:
        """Declare a publisher with the topic's delivery policy."""
        key = topic.key(**names)
        if topic.delivery is Delivery.RECOVERED:
            declared: Any = ext.declare_advanced_publisher(
                self._session,
                key,
                cache=ext.CacheConfig(max_samples=RECOVERY_CACHE),
                publisher_detection=True,
                congestion_control=zenoh.CongestionControl.BLOCK,
                sample_miss_detection=ext.MissDetectionConfig(heartbeat=HEARTBEAT_S, sporadic_heartbeat=None),
            )
        else:
            urgent = topic.delivery is Delivery.COMMAND
            declared = self._session.declare_publisher(
                key,
                encoding=f"application/msgpack;{topic.message.SCHEMA}",
                priority=zenoh.Priority.REAL_TIME if urgent else zenoh.Priority.DATA,
                express=urgent,
                congestion_control=zenoh.CongestionControl.DROP,
            )
        self._declared.append(declared)
        return Publisher(declared, topic)

    def subscribe(self, topic: Topic[M], wake: threading.Event | None = None, **names: str) -> Inbox[M]:
        """Declare a subscriber; `wake` replaces the bus's own event."""
        inbox = Inbox(
            topic.message, topic.max_bytes, CAPACITY[topic.delivery], wake or self.wake, self.counters
        )
        key = topic.key(**names)
        store: Any = zenoh.handlers.Callback(
            lambda sample: inbox.push(sample.payload.to_bytes()), indirect=False
        )
        if topic.delivery is Delivery.RECOVERED:
            declared: Any = ext.declare_advanced_subscriber(
                self._session,
                key,
                store,
                history=ext.HistoryConfig(detect_late_publishers=True, max_samples=RECOVERY_CACHE),
                recovery=ext.RecoveryConfig(periodic_queries=None, heartbeat=True),
            )
        else:
            declared = self._session.declare_subscriber(key, store)
        self._declared.append(declared)
        return inbox

    def tap(self, topic: Topic[M], store: Callable[[str, bytes], None]) -> None:
        """Hand every payload of a topic, whosever it is, to `store` with its key, on Zenoh's threads."""
        key = re.sub(r"\{\w+\}", "*", topic.template)
        handler: Any = zenoh.handlers.Callback(
            lambda sample: store(str(sample.key_expr), sample.payload.to_bytes()), indirect=False
        )
        self._declared.append(self._session.declare_subscriber(key, handler))

    def requests(
        self, query: Query[Q, R], wake: threading.Event | None = None, **names: str
    ) -> Requests[Q, R]:
        """Declare that this service answers `query`; take the questions in the loop."""
        waiting = Requests(query, wake or self.wake, self.counters)
        store = zenoh.handlers.Callback(waiting.push, indirect=False)
        self._declared.append(self._session.declare_queryable(query.key(**names), store))
        return waiting

    def ask(self, query: Query[Q, R], request: Q, timeout_s: float, **names: str) -> R:
        """Ask and wait; raises the errors of `shared.queries.ask`."""
        return queries.ask(self._session, query, query.key(**names), request, timeout_s)

    def announce(self, service: str) -> None:
        """Declare this process alive as `service`; the token goes when the process does."""
        token = self._session.liveliness().declare_token(alive_key(service, uuid.uuid4().hex))
        self._declared.append(token)

    def alive(self, service: str = "*", timeout_s: float = 1.0) -> list[str]:
        """Names of the services of this kind that are alive now, one entry per process."""
        answers = self._session.liveliness().get(alive_key(service, "*"), timeout=timeout_s)
        return sorted(str(a.ok.key_expr).split("/")[2] for a in answers if a.ok is not None)

    def watch_alive(self, changed: Callable[[str, str, bool], None], service: str = "*") -> None:
        """Call `changed(service, instance, alive)` on Zenoh's thread, for those there now and all changes."""

        def store(sample: zenoh.Sample) -> None:
            _, _, name, instance = str(sample.key_expr).split("/")
            changed(name, instance, sample.kind == zenoh.SampleKind.PUT)

        handler = zenoh.handlers.Callback(store, indirect=False)
        key = alive_key(service, "*")
        self._declared.append(self._session.liveliness().declare_subscriber(key, handler, history=True))

    def wait(self, timeout_s: float) -> bool:
        """Sleep until something arrives or `timeout_s` passes; True when something arrived."""
        arrived = self.wake.wait(timeout_s)
        self.wake.clear()
        return arrived

    def close(self) -> None:
        """Undeclare everything and close the session; a session left open hangs the interpreter at exit."""
        try:
            for declared in reversed(self._declared):
                declared.undeclare()
        finally:
            self._declared.clear()
            self._session.close()  # type: ignore[no-untyped-call]


@contextmanager
def open_bus(endpoint: str, listen: str = "tcp/127.0.0.1:0") -> Iterator[Bus]:
    """Open a peer session to the router, reachable at `listen`, and close it whatever happens."""
    bus = Bus(zenoh.open(peer_config(endpoint, listen)))
    try:
        yield bus
    finally:
        bus.close()


def wait_until(condition: Callable[[], bool], timeout_s: float, period_s: float = 0.02) -> bool:
    """Poll `condition` until it holds or `timeout_s` passes; returns whether it held."""
    deadline_s = time.monotonic() + timeout_s
    while not condition():
        if time.monotonic() > deadline_s:
            return False
        time.sleep(period_s)
    return True


__all__ = ["Bus", "Inbox", "Publisher", "Request", "Requests", "open_bus", "wait_until"]
