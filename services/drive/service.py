"""Drive loop: one velocity for each frame in lockstep, a steady stream with a watchdog in real time."""

import logging
import threading
import time

import numpy as np

from services.drive.core import Memory, compute_velocity, stop_velocity
from services.drive.inputs import STEP_S, Inputs
from services.drive.motion import OwnMotion
from services.drive.settings import DriveSettings
from shared.bus import Bus
from shared.estop.sides import EStopServer
from shared.messages.drive import Heading, Velocity
from shared.messages.sensors import Ranges
from shared.topics import HEADING, ODOMETRY, RANGES, VELOCITY

log = logging.getLogger(__name__)

HEADINGS_NEED = ("planner", "features")


class Drive:
    """Answers headings and distances with velocities."""

    def __init__(self, settings: DriveSettings, bus: Bus) -> None:
        self._settings, self._limits = settings, settings.limits()
        self._headings = bus.subscribe(HEADING, robot=settings.robot)
        self._ranges = bus.subscribe(RANGES, robot=settings.robot)
        self._odometry = bus.subscribe(ODOMETRY, robot=settings.robot)
        self._velocities = bus.publisher(VELOCITY, robot=settings.robot)
        self._inputs = Inputs(bus.counters.count)
        self._motion, self._memory = OwnMotion(), Memory()
        self._answered: Velocity | None = None
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
        for odometry in self._odometry.take_all():
            self._motion.measured(odometry)
        fresh = inputs.take(self._ranges.take(), self._headings.take(), now_s)
        self._motion.at(inputs.ranges, now_s)
        if inputs.heading is None:
            return
        if before is not None and before.mission_id != inputs.heading.mission_id:
            self._memory = Memory()
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
            self._velocities.put(answered)
        self._inputs.ranges = None

    def _answer(self, heading: Heading, ranges: Ranges) -> None:
        if self._estop.state.engaged:
            velocity = stop_velocity(heading, "emergency stop", self._limits)
        else:
            rng = np.random.default_rng((self._settings.seed, heading.seq))
            since = self._motion.since(heading)
            velocity, self._memory = compute_velocity(heading, ranges, since, self._memory, rng, self._limits)
        self._answered = self._tell(velocity)

    def _stop(self, heading: Heading, why: str) -> None:
        """Stand, said once; the robot's own time-out covers a lost message."""
        if self._moving:
            self._tell(stop_velocity(heading, why, self._limits))
            log.warning("%s: wheels stopped", why)

    def _tell(self, velocity: Velocity) -> Velocity:
        """Send a velocity with the robot's time, and remember that the robot moves like this now."""
        timed = self._motion.told(velocity)
        self._moving = not timed.stands
        self._velocities.put(timed)
        return timed

    def close(self) -> None:
        """Leave the robot standing."""
        if self._inputs.heading is not None and self._moving:
            self._tell(stop_velocity(self._inputs.heading, "drive service stops", self._limits))


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
