"""Typed access to Zenoh: publishers, subscribers, questions, liveliness; everything closes with the bus."""

import re
import threading
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any, Generic, TypeVar

import zenoh
from zenoh import ext

from shared import queries
from shared.access.credentials import Credentials, credentials_in
from shared.inbox import Counters, Inbox, wait_until
from shared.messages.base import Message
from shared.queries import Request, Requests
from shared.topics import Delivery, Query, Topic
from shared.transport.keys import alive_key
from shared.transport.reconnection import PeerReconnection
from shared.transport.session_config import client_config, peer_config
from shared.wire import WireError, encode

M = TypeVar("M", bound=Message)
Q = TypeVar("Q", bound=Message)
R = TypeVar("R", bound=Message)

CAPACITY = {Delivery.DATA: 1, Delivery.COMMAND: 1, Delivery.LOG: 1024, Delivery.RECOVERED: 4096}
"""Messages that may wait: the newest alone where older ones are worthless, seconds of the others; chosen."""
RECOVERY_CACHE = 256
"""Deltas that a publisher sends again on demand; chosen: whoever missed more reads the map anew."""
HEARTBEAT_S = 0.5
"""How soon a subscriber learns that the last delta was lost; chosen."""


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
        self._subscribers: dict[Inbox[Any], Any] = {}
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

        def keep(sample: zenoh.Sample) -> None:
            if inbox.admits(len(sample.payload)):  # before its bytes are copied
                inbox.push(sample.payload.to_bytes())

        store: Any = zenoh.handlers.Callback(keep, indirect=False)
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
        self._subscribers[inbox] = declared
        return inbox

    def unsubscribe(self, inbox: Inbox[Any]) -> None:
        """Undeclare a subscriber: nobody sends any more what only it wanted."""
        declared = self._subscribers.pop(inbox)
        self._declared.remove(declared)
        declared.undeclare()

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
        """Declare that this service answers `query`; take the questions in the loop.

        Zenoh asks only the nearest of those that declare their answers complete, and all of the others.
        """
        waiting = Requests(query, wake or self.wake, self.counters)
        store = zenoh.handlers.Callback(waiting.push, indirect=False)
        key = query.key(**names)
        self._declared.append(self._session.declare_queryable(key, store, complete=query.anyone))
        return waiting

    def ask(self, query: Query[Q, R], request: Q, timeout_s: float, **names: str) -> R:
        """Ask and wait; raises the errors of `shared.queries.ask`."""
        return queries.ask(self._session, query, query.key(**names), request, timeout_s)

    def ask_while(
        self, meanwhile: Callable[[], None], query: Query[Q, R], request: Q, timeout_s: float, **names: str
    ) -> R:
        """Ask and wait, and call `meanwhile` now and then; raises the errors of `shared.queries.ask`."""
        return queries.ask(self._session, query, query.key(**names), request, timeout_s, meanwhile)

    def announce(self, service: str) -> str:
        """Declare this process alive as `service`; its token, whose name is returned, goes when it does."""
        instance = uuid.uuid4().hex
        self.declare_token(alive_key(service, instance))
        return instance

    def declare_token(self, key: str) -> None:
        """Declare a liveliness token that goes when this process does."""
        self._declared.append(self._session.liveliness().declare_token(key))

    def alive(self, service: str = "*", timeout_s: float = 1.0) -> list[str]:
        """Names of the services of this kind that are alive now, one entry per process."""
        answers = self._session.liveliness().get(alive_key(service, "*"), timeout=timeout_s)
        keys = {
            str(answer.ok.key_expr) for answer in answers if answer.ok is not None
        }  # a client's own comes twice
        return sorted(key.split("/")[2] for key in keys)

    def watch_alive(self, changed: Callable[[str, str, bool], None], service: str = "*") -> None:
        """Call `changed(service, instance, alive)` on Zenoh's thread, for those there now and all changes."""

        def store(key: str, alive: bool) -> None:
            _, _, name, instance = key.split("/")
            changed(name, instance, alive)

        self.watch_tokens(alive_key(service, "*"), store)

    def watch_tokens(self, key: str, changed: Callable[[str, bool], None]) -> None:
        """Call `changed(key, alive)` on Zenoh's thread for the tokens there now and for all changes."""

        def store(sample: zenoh.Sample) -> None:
            changed(str(sample.key_expr), sample.kind == zenoh.SampleKind.PUT)

        handler = zenoh.handlers.Callback(store, indirect=False)
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
            self._subscribers.clear()
            self._session.close()  # type: ignore[no-untyped-call]


class UnreachableError(ConnectionError):
    """No secured router at the endpoint, or none that takes this certificate."""


@contextmanager
def open_bus(endpoint: str, listen: str = "tcp/127.0.0.1:0", certs: Path | None = None) -> Iterator[Bus]:
    """Open a session to the router at `endpoint` and close it whatever happens.

    Without certificates in the folder `certs` it is a peer, reachable at `listen`, which never waits for the
    router and looks for peers that it lost. With certificates it is a client, which listens nowhere and waits
    up to ten seconds.

    Raises:
        CredentialsError: the folder cannot be used, or the endpoint is secured and there is none.
        UnreachableError: no router, or it refuses this certificate.
    """
    credentials = credentials_in(certs)
    if credentials is None:
        session = zenoh.open(peer_config(endpoint, listen))
    else:
        session = _secured_session(endpoint, credentials)
    bus = Bus(session)
    try:
        with PeerReconnection(session, endpoint) if credentials is None else nullcontext():
            yield bus
    finally:
        bus.close()


def _secured_session(endpoint: str, credentials: Credentials) -> zenoh.Session:
    try:
        return zenoh.open(client_config(endpoint, credentials))
    except zenoh.ZError as error:
        raise UnreachableError(
            f"no secured router at {endpoint} takes the certificate in {credentials.certificate.parent}: "
            f"is it up, of the same authority, and not expired ('topnav certs --check')? {str(error)[:200]}"
        ) from error


__all__ = ["Bus", "Inbox", "Publisher", "Request", "Requests", "UnreachableError", "open_bus", "wait_until"]
