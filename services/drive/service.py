"""Drive loop: one command for each frame in lockstep, a steady stream with a watchdog in real time."""

import logging
import threading
import time

import numpy as np

from services.drive.core import compute_command, stop_command
from services.drive.passing import Passing
from services.drive.settings import DriveSettings
from shared.bus import Bus
from shared.messages import Command, Heading, Ranges
from shared.topics import COMMAND, HEADING, RANGES

log = logging.getLogger(__name__)

PERIOD_S = 0.05
RANGES_TTL_S = 0.4
EXPIRED_S = -1.0e9
HEADINGS_NEED = ("planner", "features")


class Drive:
    """Keeps the newest heading and distances and answers with commands."""

    def __init__(self, settings: DriveSettings, bus: Bus) -> None:
        self._settings, self._limits = settings, settings.limits()
        self._headings = bus.subscribe(HEADING, robot=settings.robot)
        self._ranges_in = bus.subscribe(RANGES, robot=settings.robot)
        self._commands = bus.publisher(COMMAND, robot=settings.robot)
        self._memory = Passing()
        self._heading: Heading | None = None
        self._ranges: Ranges | None = None
        self._heading_s = self._ranges_s = EXPIRED_S
        self._answered: Command | None = None
        self._moving = False
        self._counters = bus.counters
        self._bereft, self._wake = threading.Event(), bus.wake
        for service in HEADINGS_NEED:
            bus.watch_alive(self._watch, service)

    def turn(self, now_s: float) -> None:
        """Read what came and send what follows from it."""
        if self._bereft.is_set():
            self._bereft.clear()
            self._heading_s = EXPIRED_S
        fresh_ranges = self._ranges_in.take()
        if fresh_ranges is not None:
            self._ranges, self._ranges_s = fresh_ranges, now_s
        fresh_heading = self._headings.take()
        if fresh_heading is not None and self._accept(fresh_heading):
            self._heading, self._heading_s = fresh_heading, now_s
        if self._heading is None or self._ranges is None:
            return
        if self._ranges.lockstep:
            self._answer_once(self._heading, self._ranges)
        elif now_s - self._heading_s > self._heading.ttl_ms / 1000.0 or now_s - self._ranges_s > RANGES_TTL_S:
            self._stop(self._heading)
        elif fresh_ranges is not None or fresh_heading is not None:
            self._answer(self._heading, self._ranges)

    def _watch(self, _service: str, _instance: str, alive: bool) -> None:
        """A service that headings come from is gone: they expire at once. Called on Zenoh's thread."""
        if not alive:
            self._bereft.set()
            self._wake.set()

    def _accept(self, heading: Heading) -> bool:
        """Refuse headings of a planner that has been replaced."""
        if self._heading is not None and heading.epoch < self._heading.epoch:
            self._counters.count(
                "old_epoch", f"heading of epoch {heading.epoch}, newest is {self._heading.epoch}"
            )
            return False
        if self._heading is None or heading.mission_id != self._heading.mission_id:
            self._memory = Passing()
        return True

    def _answer_once(self, heading: Heading, ranges: Ranges) -> None:
        """Lockstep: pair heading and distances of one frame; repeat the same answer when asked again."""
        if heading.seq != ranges.seq:
            return
        answered = self._answered
        if answered is not None and (answered.seq, answered.stamp_ns) == (heading.seq, heading.stamp_ns):
            self._commands.put(answered)
        else:
            self._answer(heading, ranges)
        self._ranges = None

    def _answer(self, heading: Heading, ranges: Ranges) -> None:
        rng = np.random.default_rng((self._settings.seed, heading.seq))
        self._answered, self._memory = compute_command(heading, ranges, self._memory, rng, self._limits)
        self._moving = self._answered.wheel_speed_radps != 0.0
        self._commands.put(self._answered)

    def _stop(self, heading: Heading) -> None:
        """Once the inputs are too old: zero command; the robot's own time-out covers a lost one."""
        if self._moving:
            self._commands.put(stop_command(heading, "inputs too old", self._limits))
            log.warning("inputs too old: wheels stopped")
            self._moving = False

    def close(self) -> None:
        """Leave the robot with a zero command."""
        if self._heading is not None and self._moving:
            self._commands.put(stop_command(self._heading, "drive service stops", self._limits))


def run(settings: DriveSettings, bus: Bus, stop: threading.Event) -> None:
    """Serve until `stop`."""
    drive = Drive(settings, bus)
    bus.announce("drive")
    try:
        while not stop.is_set():
            bus.wait(PERIOD_S)
            drive.turn(time.monotonic())
    finally:
        drive.close()
