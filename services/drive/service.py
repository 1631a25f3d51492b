"""Drive loop: one command for each frame in lockstep, a steady stream with a watchdog in real time."""

import logging
import threading
import time

import numpy as np

from services.drive.core import compute_command, stop_command
from services.drive.inputs import STEP_S, Inputs
from services.drive.passing import Passing
from services.drive.settings import DriveSettings
from shared.bus import Bus
from shared.estop.sides import EStopServer
from shared.messages.drive import Command, Heading
from shared.messages.sensors import Ranges
from shared.topics import COMMAND, HEADING, RANGES

log = logging.getLogger(__name__)

HEADINGS_NEED = ("planner", "features")


class Drive:
    """Answers headings and distances with commands."""

    def __init__(self, settings: DriveSettings, bus: Bus) -> None:
        self._settings, self._limits = settings, settings.limits()
        self._headings = bus.subscribe(HEADING, robot=settings.robot)
        self._ranges = bus.subscribe(RANGES, robot=settings.robot)
        self._commands = bus.publisher(COMMAND, robot=settings.robot)
        self._inputs = Inputs(bus.counters.count)
        self._passing = Passing()
        self._answered: Command | None = None
        self._moving = False
        self._estop = EStopServer(bus, settings.robot, settings.state_dir)
        self._source_lost, self._wake = threading.Event(), bus.wake
        for service in HEADINGS_NEED:
            bus.watch_alive(self._watch, service)

    def step(self, now_s: float) -> None:
        """Read what came and send what follows from it."""
        self._estop.step(now_s)
        inputs, before = self._inputs, self._inputs.heading
        if self._source_lost.is_set():
            self._source_lost.clear()
            inputs.expire_heading()
        fresh = inputs.take(self._ranges.take(), self._headings.take(), now_s)
        if inputs.heading is None:
            return
        if before is not None and before.mission_id != inputs.heading.mission_id:
            self._passing = Passing()
        if self._estop.state.engaged and self._moving:
            self._stop(inputs.heading, "emergency stop")
        if inputs.ranges is None:
            return
        if inputs.ranges.lockstep:
            self._answer_once(inputs.heading, inputs.ranges)
        elif inputs.too_old(now_s):
            self._stop(inputs.heading, "inputs too old")
        elif fresh:
            self._answer(inputs.heading, inputs.ranges)

    def _watch(self, _service: str, _instance: str, alive: bool) -> None:
        """A service that headings come from is gone: they expire at once. Called on Zenoh's thread."""
        if not alive:
            self._source_lost.set()
            self._wake.set()

    def _answer_once(self, heading: Heading, ranges: Ranges) -> None:
        """Lockstep: pair heading and distances of one frame; repeat the same answer when asked again."""
        if heading.seq != ranges.seq:
            return
        answered, frame = self._answered, (heading.seq, heading.stamp_ns)
        if self._estop.state.engaged or answered is None or (answered.seq, answered.stamp_ns) != frame:
            self._answer(heading, ranges)
        else:
            self._commands.put(answered)
        self._inputs.ranges = None

    def _answer(self, heading: Heading, ranges: Ranges) -> None:
        if self._estop.state.engaged:
            self._answered = stop_command(heading, "emergency stop", self._limits)
        else:
            rng = np.random.default_rng((self._settings.seed, heading.seq))
            self._answered, self._passing = compute_command(heading, ranges, self._passing, rng, self._limits)
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
        if self._inputs.heading is not None and self._moving:
            self._commands.put(stop_command(self._inputs.heading, "drive service stops", self._limits))


def run(settings: DriveSettings, bus: Bus, stop: threading.Event) -> None:
    """Serve until `stop`."""
    drive = Drive(settings, bus)
    bus.announce("drive")
    try:
        while not stop.is_set():
            bus.wait(STEP_S)
            drive.step(time.monotonic())
    finally:
        drive.close()
