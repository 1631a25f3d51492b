"""Drive loop: one velocity for each frame in lockstep, a steady stream with a watchdog in real time."""

import logging
import math
import threading
import time

import numpy as np

from services.drive.bases.course import Twist
from services.drive.by_hand import Hand, by_hand
from services.drive.core import Memory, compute_velocity, stop_velocity
from services.drive.inputs import STEP_S, Inputs
from services.drive.motion import OwnMotion
from services.drive.settings import DriveSettings
from shared.bus import Bus
from shared.estop.sides import EStopServer
from shared.geometry.clearance import Obstacles
from shared.messages.drive import Heading, Manual, Velocity
from shared.messages.sensors import Ranges
from shared.topics import HEADING, MANUAL, ODOMETRY, RANGES, VELOCITY

log = logging.getLogger(__name__)

HEADINGS_NEED = ("planner", "features")


class Drive:
    """Answers headings, or the wishes of a person who drives, and distances with velocities."""

    def __init__(self, settings: DriveSettings, bus: Bus) -> None:
        self._settings, self._limits = settings, settings.limits()
        self._headings = bus.subscribe(HEADING, robot=settings.robot)
        self._ranges = bus.subscribe(RANGES, robot=settings.robot)
        self._odometry = bus.subscribe(ODOMETRY, robot=settings.robot)
        self._wishes = bus.subscribe(MANUAL, robot=settings.robot)
        self._velocities = bus.publisher(VELOCITY, robot=settings.robot)
        self._hand, self._driver, self._last_s = Hand(bus.counters.count), "", math.inf
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
        if self._follow_hand(now_s, fresh=fresh) or inputs.heading is None:
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

    def _follow_hand(self, now_s: float, *, fresh: bool) -> bool:
        """Do what a person wishes, stand once they let go; False while nobody drives.

        A wish may have waited since the last step: its age counts from then.
        """
        wishes = self._wishes.take_all()
        for one in wishes:
            self._hand.hear(one, min(self._last_s, now_s))
        self._last_s = now_s
        wish, ranges = self._hand.wish(now_s), self._inputs.ranges
        if wish is None:
            if self._driver:
                log.info("%s let go", self._driver)
                self._driver = ""
                self._inputs.expire_heading()
                self._tell_by_hand(Twist(), "nobody drives by hand any more")
            return False
        if not self._driver:
            log.info("%s drives by hand", wish.who)
        self._driver = wish.who
        if self._estop.state.engaged:
            self._tell_by_hand(Twist(), "emergency stop")
        elif ranges is None or self._inputs.are_ranges_too_old(now_s):
            self._tell_by_hand(Twist(), "no distances to drive by")
        elif fresh or wishes:
            self._obey(wish, ranges)
        return True

    def _obey(self, wish: Manual, ranges: Ranges) -> None:
        obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
        self._tell_by_hand(by_hand(wish, obstacles, self._limits), f"by hand: {wish.who}")

    def _tell_by_hand(self, twist: Twist, why: str) -> None:
        """Move or stand. Standing is said once, for the robot's own time-out covers a lost message.

        In lockstep all distances are answered, and each only once.
        """
        ranges, heading = self._inputs.newest_ranges, self._inputs.heading
        if ranges is None or (ranges.lockstep and self._inputs.ranges is None):
            return
        if twist == Twist() and not (self._moving or ranges.lockstep):
            return
        self._inputs.answered()
        self._memory = Memory()
        self._answered = self._tell(
            Velocity(
                seq=ranges.seq,
                stamp_ns=ranges.stamp_ns,
                robot=self._settings.robot,
                epoch=0 if heading is None else heading.epoch,
                ttl_ms=self._limits.command_ttl_ms,
                why=why,
                **twist._asdict(),
            )
        )

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
        self._inputs.answered()

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
