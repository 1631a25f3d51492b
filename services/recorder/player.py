"""Replaying: the messages of a recording go out again, spaced as they came."""

import threading
import time
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping

from services.recorder.backlog import Sample
from services.recorder.channels import name_of, topic_of
from shared.bus import Bus, Publisher
from shared.messages.base import Message
from shared.topics import Topic
from shared.wire import decode, encode


class Player:
    """Publishes recorded messages under their own keys, or with other robots' names."""

    def __init__(
        self, bus: Bus, remap: Mapping[str, str] | None = None, without: Collection[str] = ("delta",)
    ) -> None:
        """Prepare.

        Args:
            bus: to publish on.
            remap: robot of the recording -> its name in the replay.
            without: topics left out. Changes of maps are: the map store holds the maps and would be
                contradicted.
        """
        self._bus, self._remap, self._without = bus, remap or {}, without
        self._publishers: dict[str, Publisher[Message]] = {}
        self.counts: Counter[str] = Counter()

    def put(self, sample: Sample) -> None:
        """Publish one message.

        Raises:
            WireError: it is to be renamed and is no valid message.
        """
        found = topic_of(sample.key)
        if found is None or name_of(found[0]) in self._without:
            return
        topic, names = found
        payload = sample.payload
        robot = self._remap.get(names.get("robot", ""))
        if robot is not None:
            names = {**names, "robot": robot}
            payload = _renamed(topic, payload, robot)
        key = topic.key(**names)
        if key not in self._publishers:
            self._publishers[key] = self._bus.publisher(topic, **names)
        self._publishers[key].put_bytes(payload)
        self.counts[key] += 1


def play(
    samples: Iterable[Sample],
    put: Callable[[Sample], None],
    rate: float,
    stop: threading.Event,
    clock_s: Callable[[], float] = time.monotonic,
    wait: Callable[[float], object] | None = None,
) -> None:
    """Hand each sample to `put` when its time has come, `rate` times as fast as recorded, until `stop`.

    Args:
        samples: in the order of arrival.
        put: publishes one.
        rate: 2 plays twice as fast.
        stop: ends the replay between two messages.
        clock_s: seconds that never go back.
        wait: sleeps so many seconds, or less when `stop` is set.
    """
    pause = wait or stop.wait
    first_ns: int | None = None
    began_s = clock_s()
    for sample in samples:
        first_ns = sample.arrived_ns if first_ns is None else first_ns
        due_s = began_s + (sample.arrived_ns - first_ns) / 1e9 / rate
        while (left_s := due_s - clock_s()) > 0.0 and not stop.is_set():
            pause(left_s)
        if stop.is_set():
            return
        put(sample)


def _renamed(topic: Topic[Message], payload: bytes, robot: str) -> bytes:
    message = decode(topic.message, payload, topic.max_bytes)
    return encode(message.model_copy(update={"robot": robot}))
