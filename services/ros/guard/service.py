"""Guard loop: velocities in, safe ones out, whoever died. It knows ROS only, not topnav's bus."""

import logging
import threading
import time

from services.ros.base_link import BaseLink
from services.ros.conversions.header import ConversionError, check_frame, stamp_s
from services.ros.conversions.robot_clock import RobotClock
from services.ros.conversions.scan import sectors_of
from services.ros.conversions.twist import STAND, motion_of
from services.ros.guard.core import GuardCore
from services.ros.repeating import Repeating
from services.ros.robot_file import Guard, RobotFile
from services.ros.sensing import SCAN
from services.ros.settings import RosSettings
from services.ros.wires.codec import Codec, CodecError
from services.ros.wires.opening import wait_for_wire
from services.ros.wires.wire import GUARD_NODE, URGENT, Deliver, Wire
from shared.inbox import Counters

log = logging.getLogger(__name__)

PERIOD_S = 0.05
"""Chosen: five times within the life of a command."""
SUSPENDED_S = 0.25
"""A loop that stood still so long itself obeys nothing that waited for it: chosen, the life of a command."""


class RobotGuard:
    """Stands between whoever drives and the base."""

    def __init__(self, file: RobotFile, guard: Guard, wire: Wire, codec: Codec) -> None:
        self._file, self._wire, self._codec = file, wire, codec
        self._core, self._clock = GuardCore(guard, PERIOD_S), RobotClock()
        self._base, self._repeating = BaseLink(wire, codec, guard), Repeating()
        self._counters, self._wake = Counters(), threading.Event()
        self._lock = threading.Lock()
        self._newest: dict[str, tuple[bytes, float]] = {}
        self._last_s, self._ignore_until_s = time.monotonic(), float("-inf")
        wire.subscribe(file.scan.topic, SCAN, self._store(SCAN))
        heard = file.velocity.types()[0]  # who speaks to us reads the type from us
        wire.subscribe(file.velocity.topic, heard, self._store(heard), URGENT)

    def wait(self) -> None:
        """Sleep until something came or a period passed."""
        self._wake.wait(PERIOD_S)
        self._wake.clear()

    def step(self, now_s: float) -> None:
        """Read what came and tell the base what is safe.

        Raises:
            WireError: ROS is gone.
        """
        self._wire.require_up()
        if now_s - self._last_s > SUSPENDED_S:
            log.warning("suspended for %.1f s: what came meanwhile is thrown away", now_s - self._last_s)
            self._ignore_until_s = now_s + PERIOD_S
        self._last_s = now_s
        with self._lock:
            newest, self._newest = self._newest, {}
        if now_s >= self._ignore_until_s:
            for kind, (payload, came_s) in newest.items():
                self._read(kind, payload, came_s)
        verdict = self._core.verdict(now_s)
        if verdict.why:
            self._counters.count(verdict.kind, verdict.why)
        if self._repeating.due(verdict.motion, now_s):
            if problem := self._base.problem():
                self._counters.count("base", problem)
            offset_s = self._clock.offset_s
            self._base.send(verdict.motion, None if offset_s is None else now_s + offset_s)

    def close(self) -> None:
        """Leave the base with a word to stand."""
        self._base.send(STAND, None)

    def _store(self, kind: str) -> Deliver:
        def store(payload: bytes, came_s: float) -> None:
            with self._lock:
                self._newest[kind] = payload, came_s
            self._wake.set()

        return store

    def _read(self, kind: str, payload: bytes, came_s: float) -> None:
        topic = self._file.scan.topic if kind == SCAN else self._file.velocity.topic
        try:
            message = self._codec.decode(kind, payload)
            if kind != SCAN:
                self._core.hear(motion_of(message, kind), came_s)
                return
            check_frame(message, self._file.scan.frame)
            stamp = stamp_s(message)
            if stamp is not None and self._clock.judge(stamp, came_s).verdict != "good":
                raise ConversionError("held up, or the robot's clock jumped")
            scan = self._file.scan
            most_m = min(scan.max_m, float(message.range_max))
            self._core.see(sectors_of(message, scan.mount, scan.own_radius_m, most_m, scan.nothing), came_s)
        except (CodecError, ConversionError) as error:
            self._counters.count(f"bad {topic}", f"{topic}: {error}")


def run(settings: RosSettings, file: RobotFile, guard: Guard, stop: threading.Event) -> None:
    """Guard until `stop`.

    Raises:
        WireError: ROS ended.
    """
    codec = Codec(file.wire.distribution)
    wire = wait_for_wire(file.wire, codec, GUARD_NODE, settings.interpreter, stop)
    if wire is None:
        return
    try:
        robot_guard = RobotGuard(file, guard, wire, codec)
        log.info("%s: %s to %s", file.name, file.velocity.topic, guard.topic)
        try:
            while not stop.is_set():
                robot_guard.wait()
                robot_guard.step(time.monotonic())
        finally:
            robot_guard.close()
    finally:
        wire.close()
