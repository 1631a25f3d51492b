"""A robot as the feature service sees it: frames, and a question about the nodes around each."""

import math
import threading
import time
from collections.abc import Sequence
from dataclasses import dataclass

from experiments.rendered.frames import camera
from experiments.scale.frames import Seen, WorldFrames
from experiments.scale.measure import TRACKED
from shared.bus import Bus
from shared.messages.matching import MatchRequest
from shared.messages.sensors import Frame
from shared.topics import FEATURES, FRAME, MATCH
from simulator.world.world_file import load_world

MAP_NAME, VIEWS = "robots", 32
"""Map of all robots, and how many frames they send in turn."""

ASK_S, AGAIN_S = 30.0, 0.5
"""Patience with a question, and with a frame before it is sent again: the simulator's own in lockstep."""


@dataclass(frozen=True, eq=False)
class View:
    """A frame as the simulator sends it, and the nodes of the map around it."""

    frame: Frame
    near: tuple[int, ...]


def views_of(frames: WorldFrames) -> list[View]:
    """What the camera sees where some of the pictures were taken; loads SAPIEN."""
    asked = frames.queries[:VIEWS]
    shoot = camera(load_world(asked[0].world))
    return [View(shoot(seen.pose), _near(seen, frames.nodes)) for seen in asked]


def _near(seen: Seen, nodes: Sequence[Seen]) -> tuple[int, ...]:
    def apart_m(number: int) -> float:
        pose = nodes[number].pose
        return math.dist((pose.x_m, pose.y_m), (seen.pose.x_m, seen.pose.y_m))

    return tuple(sorted(range(len(nodes)), key=apart_m)[:TRACKED])


class AskingRobot:
    """One robot with a frame under way at a time, as in lockstep."""

    def __init__(self, bus: Bus, name: str, views: Sequence[View]) -> None:
        self._bus, self._name, self._views = bus, name, views
        self._wake = threading.Event()
        self._frames = bus.publisher(FRAME, robot=name)
        self._features = bus.subscribe(FEATURES, self._wake, robot=name)
        self._seq = 0
        self.waits_ms: list[float] = []

    def drive(self, stop: threading.Event, rate_hz: float, phase: float) -> None:
        """Step until `stop`, so often at most: a robot that is late does not catch up.

        Args:
            stop: ends it after the step under way.
            rate_hz: 0 steps as fast as it is answered.
            phase: share of a period before the first step, so that robots do not march in time.
        """
        period_s = 1.0 / rate_hz if rate_hz else 0.0
        next_s = time.monotonic() + phase * period_s
        while not stop.wait(max(0.0, next_s - time.monotonic())):
            self.waits_ms.append(self.step())
            next_s = max(next_s + period_s, time.monotonic())

    def step(self) -> float:
        """Milliseconds from a frame to the answer about the nodes around it."""
        view, self._seq = self._views[self._seq % len(self._views)], self._seq + 1
        moment = {"seq": self._seq, "stamp_ns": time.time_ns(), "robot": self._name, "lockstep": True}
        frame = view.frame.model_copy(update=moment)
        start_s = time.perf_counter()
        self._frames.put(frame)
        self._await_features(frame)
        asked = {"map": MAP_NAME, "map_revision": 1, "node_ids": view.near}
        self._bus.ask(
            MATCH, MatchRequest(seq=frame.seq, stamp_ns=frame.stamp_ns, **asked), ASK_S, robot=self._name
        )
        return (time.perf_counter() - start_s) * 1e3

    def _await_features(self, frame: Frame) -> None:
        """Until they come; a frame that was dropped under load is sent again, as a simulator does."""
        again_s = time.monotonic() + AGAIN_S
        while (features := self._features.take()) is None or features.seq != frame.seq:
            self._wake.wait(max(0.0, again_s - time.monotonic()))
            self._wake.clear()
            if time.monotonic() > again_s:
                self._frames.put(frame)
                again_s += AGAIN_S
