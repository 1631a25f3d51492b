"""Drive loop: one command for each frame in lockstep, a steady stream with a watchdog in real time."""

import logging
import math
import threading
import time

import numpy as np

from services.drive.ages import FrameAges
from services.drive.core import compute_command, is_behind, is_overtaken, is_stale, stop_command
from services.drive.passing import Passing
from services.drive.settings import DriveSettings
from shared.bus import Bus
from shared.estop.sides import StopDesk
from shared.messages import Command, Heading, Ranges
from shared.topics import COMMAND, HEADING, RANGES

log = logging.getLogger(__name__)

PERIOD_S = 0.05
RANGES_TTL_S = 0.4
EXPIRED_S = -1.0e9
SUSPENDED_S = 0.5
"""A loop that turns 20 times a second and missed this long stood still itself, with everything it heard."""
BURST_S = 0.2
"""After that, or after the network was cut, what had piled up arrives within this."""
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
        self._heading_s = self._ranges_s = self._sensed_s = EXPIRED_S
        self._ages, self._lockstep = FrameAges(), False
        self._last_heading: Heading | None = None  # for the order; a silent robot may come back restarted
        self._last_ranges: Ranges | None = None
        self._answered: Command | None = None
        self._moving = False
        self._counters = bus.counters
        self._bereft, self._wake = threading.Event(), bus.wake
        self._desk = StopDesk(bus, settings.robot, settings.state_dir)
        self._turned_s, self._deaf_until_s = math.inf, EXPIRED_S
        for service in HEADINGS_NEED:
            bus.watch_alive(self._watch, service)

    def turn(self, now_s: float) -> None:
        """Read what came and send what follows from it."""
        self._desk.turn(now_s)
        if self._bereft.is_set():
            self._bereft.clear()
            self._heading_s = EXPIRED_S
        fresh = self._listen(now_s)
        if self._heading is None:
            return
        if self._desk.state.engaged and self._moving:
            self._stop(self._heading, "emergency stop")
        if self._ranges is None:
            return
        if self._ranges.lockstep:
            self._answer_once(self._heading, self._ranges)
        elif now_s - self._heading_s > self._heading.ttl_ms / 1000.0 or now_s - self._ranges_s > RANGES_TTL_S:
            self._stop(self._heading, "inputs too old")
        elif fresh:
            self._answer(self._heading, self._ranges)

    def _listen(self, now_s: float) -> bool:
        """Take the newest heading and distances; whether there was news.

        What waited while this process was suspended, or cut off from the robot, may be as old as that, and
        looks fresh when it is read: it is thrown away. What is read now may have come just after the last
        turn, so its age is counted from then.
        """
        since_s = min(self._turned_s, now_s)
        if now_s - since_s > SUSPENDED_S:
            log.warning("suspended for %.1f s: what came meanwhile is thrown away", now_s - since_s)
            self._be_deaf(now_s)
        elif since_s < self._deaf_until_s:  # a burst waits for as long as this process was held up
            self._deaf_until_s += max(0.0, now_s - since_s - PERIOD_S)
        self._turned_s = now_s
        ranges, heading = self._ranges_in.take(), self._headings.take()
        if ranges is not None:
            self._sense(ranges, now_s)
        if now_s < self._deaf_until_s:
            return False
        fresh = ranges is not None and self._take_ranges(ranges, now_s, since_s)
        if heading is None or not self._accept(heading, now_s):
            return fresh
        self._heading, self._heading_s = heading, since_s
        self._last_heading = heading
        return True

    def _sense(self, ranges: Ranges, now_s: float) -> None:
        """The robot is heard; after a silence what comes first may have been sent long ago."""
        silent_s = now_s - self._sensed_s
        if not ranges.lockstep and self._ranges is not None and silent_s > RANGES_TTL_S:
            self._counters.count("silence", f"nothing from the robot for {silent_s:.1f} s")
            self._be_deaf(now_s)
            self._last_heading = self._last_ranges = None
        self._sensed_s = now_s

    def _be_deaf(self, now_s: float) -> None:
        self._heading_s, self._deaf_until_s = EXPIRED_S, now_s + BURST_S

    def _take_ranges(self, ranges: Ranges, now_s: float, since_s: float) -> bool:
        last = self._last_ranges
        if last is not None and is_behind(ranges, last):
            self._counters.count("late", f"distances of frame {ranges.seq} after those of {last.seq}")
            return False
        self._ranges = self._last_ranges = ranges
        self._ranges_s, self._lockstep = since_s, ranges.lockstep
        self._ages.heard(ranges.seq, now_s)
        return True

    def _watch(self, _service: str, _instance: str, alive: bool) -> None:
        """A service that headings come from is gone: they expire at once. Called on Zenoh's thread."""
        if not alive:
            self._bereft.set()
            self._wake.set()

    def _accept(self, heading: Heading, now_s: float) -> bool:
        """Refuse headings of a planner that was replaced, that were overtaken, or held up on their way."""
        newest, last = self._heading, self._last_heading
        if newest is not None and heading.epoch < newest.epoch:
            self._counters.count("old_epoch", f"heading of epoch {heading.epoch}, newest is {newest.epoch}")
            return False
        if last is not None and not self._lockstep and is_overtaken(heading, last):
            self._counters.count("late", f"heading of frame {heading.seq} after that of {last.seq}")
            return False
        age_s = self._ages.age_s(heading.seq, now_s)
        if not self._lockstep and is_stale(heading, age_s):
            self._counters.count("stale", f"heading of frame {heading.seq}, which is {age_s:.1f} s old")
            return False
        if self._heading is None or heading.mission_id != self._heading.mission_id:
            self._memory = Passing()
        return True

    def _answer_once(self, heading: Heading, ranges: Ranges) -> None:
        """Lockstep: pair heading and distances of one frame; repeat the same answer when asked again."""
        if heading.seq != ranges.seq:
            return
        answered, frame = self._answered, (heading.seq, heading.stamp_ns)
        if self._desk.state.engaged or answered is None or (answered.seq, answered.stamp_ns) != frame:
            self._answer(heading, ranges)
        else:
            self._commands.put(answered)
        self._ranges = None

    def _answer(self, heading: Heading, ranges: Ranges) -> None:
        if self._desk.state.engaged:
            self._answered = stop_command(heading, "emergency stop", self._limits)
        else:
            rng = np.random.default_rng((self._settings.seed, heading.seq))
            self._answered, self._memory = compute_command(heading, ranges, self._memory, rng, self._limits)
        self._moving = self._answered.wheel_speed_radps != 0.0
        self._commands.put(self._answered)

    def _stop(self, heading: Heading, why: str) -> None:
        """Zero command, once; the robot's own time-out covers a lost one."""
        if self._moving:
            self._commands.put(stop_command(heading, why, self._limits))
            log.warning("%s: wheels stopped", why)
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
