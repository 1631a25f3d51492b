"""From the bus's threads to asyncio: one thread waits on the bus and hands batches to the hub."""

import asyncio
import threading
from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from services.gateway.live.hub import Hub
from shared.bus import Bus
from shared.messages.base import Message
from shared.topics import (
    BATTERY,
    CAMERA_STATE,
    ESTOP_STATE,
    EVENT,
    FLEET_QUEUE,
    FRAME,
    HEADING,
    IMU,
    ODOMETRY,
    QUEUE,
    RANGES,
    STATUS,
    TRUTH,
    VELOCITY,
    Topic,
)
from shared.transport.keys import is_robot

PERIOD_S = 0.25
"""Chosen: the bus wakes the thread for whatever it carries; this is for what does not."""
DELIVERY_S = 5.0
"""As GATEWAY_SEND_TIMEOUT_S: asyncio's thread is never busy for longer."""
BEAT_S = 2.0
"""A third of the silence after which the console connects again, less what a beat may be late."""

QUEUED: tuple[Topic[Any], ...] = (STATUS, EVENT, TRUTH)
NEWEST: tuple[Topic[Any], ...] = (
    FRAME,
    RANGES,
    HEADING,
    VELOCITY,
    ESTOP_STATE,
    ODOMETRY,
    IMU,
    BATTERY,
    CAMERA_STATE,
    QUEUE,
)
"""Of these an inbox keeps the newest only: under '*' robots would displace each other."""
TELLING: tuple[Topic[Any], ...] = (RANGES, ESTOP_STATE)
"""Of these enough arrives under '*' to tell that there is another robot."""

Inbox = Callable[[], Sequence[Message]]
"""Takes all that waits in one inbox."""


class Alive:
    """Which processes live; written on Zenoh's threads."""

    def __init__(self, wake: threading.Event) -> None:
        self._lock, self._wake = threading.Lock(), wake
        self._instances: set[tuple[str, str]] = set()

    def change(self, service: str, instance: str, alive: bool) -> None:
        """Note one process that came or went."""
        with self._lock:
            (self._instances.add if alive else self._instances.discard)((service, instance))
        self._wake.set()

    def counts(self) -> dict[str, int]:
        """Living processes per service."""
        with self._lock:
            return dict(sorted(Counter(service for service, _ in self._instances).items()))


class Bridge:
    """Follows the given robot from the start and others as soon as they say something."""

    def __init__(
        self, bus: Bus, hub: Hub, loop: asyncio.AbstractEventLoop, robot: str, max_robots: int
    ) -> None:
        self._bus, self._hub, self._loop = bus, hub, loop
        self._max_robots = max_robots
        self._stop = threading.Event()
        self._alive = Alive(bus.wake)
        self._followed: dict[str, tuple[Inbox, ...]] = {}
        self._queued, self._telling = self._subscribed(QUEUED, "*"), self._subscribed(TELLING, "*")
        self._queued += (bus.subscribe(FLEET_QUEUE).take_all,)
        self._follow(robot)
        bus.watch_alive(self._alive.change)
        self._thread = threading.Thread(target=self._run, name="bridge", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def stop(self) -> None:
        """Ask the thread to end without waiting: it may itself wait for the asyncio thread."""
        self._stop.set()
        self._bus.wake.set()

    def _run(self) -> None:
        services: dict[str, int] = {}
        while not self._stop.is_set():
            self._bus.wait(PERIOD_S)
            counts = self._alive.counts()
            messages = self._collect()
            if counts != services and self._deliver(messages, counts):
                services = counts
            elif messages:
                self._deliver(messages, None)

    def _collect(self) -> list[Message]:
        messages = _all_of(self._queued)
        for message in (*_all_of(self._telling), *messages):
            self._follow(str(getattr(message, "robot", "")))
        for inboxes in self._followed.values():
            messages += _all_of(inboxes)
        return messages

    def _follow(self, robot: str) -> None:
        if robot not in self._followed and len(self._followed) < self._max_robots and is_robot(robot):
            self._followed[robot] = self._subscribed(NEWEST, robot)

    def _subscribed(self, topics: Iterable[Topic[Any]], robot: str) -> tuple[Inbox, ...]:
        return tuple(self._bus.subscribe(topic, robot=robot).take_all for topic in topics)

    def _deliver(self, messages: list[Message], services: dict[str, int] | None) -> bool:
        """Hand over and wait until taken: under load the bounded inboxes fill, not asyncio's queue."""
        taken = threading.Event()

        def hand_over() -> None:
            try:
                self._hub.take(messages)
                if services is not None:
                    self._hub.take_services(services)
            finally:
                taken.set()

        try:
            self._loop.call_soon_threadsafe(hand_over)
        except RuntimeError:  # the loop closed: the gateway is stopping
            self._stop.set()
            return False
        return taken.wait(DELIVERY_S)


def _all_of(inboxes: Iterable[Inbox]) -> list[Message]:
    return [message for take_all in inboxes for message in take_all()]
