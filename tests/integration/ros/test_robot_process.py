"""The ROS service between a robot in ROS and topnav's bus: what is sensed, driven, refused and stopped."""

import itertools
import time

import numpy as np
import pytest

from services.ros.conversions.twist import STAND, Motion
from shared.bus import wait_until
from shared.messages.drive import Velocity
from shared.messages.estop import EStopState
from shared.topics import ESTOP_STATE, FRAME, ODOMETRY, RANGES, ROBOT_ESTOP_STATE, VELOCITY
from tests.integration.ros.conftest import SOON_S
from tests.ros_messages import TWIST, TWIST_STAMPED

AHEAD = Motion(0.25, 0.125, -0.5)
ZENOH = pytest.mark.parametrize("choice", ["rmw_zenoh"], indirect=True)


class Drive:
    """topnav's drive: answers the newest frame with one velocity, again and again."""

    def __init__(self, bus):
        self.bus = bus
        self.frames, self.seq = bus.subscribe(FRAME, robot="r1"), 0
        self._velocities = bus.publisher(VELOCITY, robot="r1")

    def says(self, motion=AHEAD, seq=None):
        frame = self.frames.take()
        self.seq = frame.seq if frame is not None else self.seq
        said = {
            "forward_mps": motion.forward_mps,
            "left_mps": motion.left_mps,
            "turn_radps": motion.turn_radps,
        }
        self._velocities.put(Velocity(seq=seq or self.seq, robot="r1", ttl_ms=300, **said))

    def until(self, reached, motion=AHEAD):
        """Say it until something is reached."""

        def step():
            self.says(motion)
            return reached()

        return wait_until(step, SOON_S)


@pytest.fixture
def drive(bus):
    return Drive(bus)


@pytest.fixture
def started(start, bus):
    """A service that is alive."""

    def launch(**changes):
        process = start("services.ros", **changes)
        assert wait_until(lambda: bus.alive("ros") != [], SOON_S), process.log
        return process

    return launch


def test_what_the_robot_senses_is_on_the_bus_and_what_drive_says_reaches_its_base(robot, started, bus, drive):
    base = robot(TWIST_STAMPED)
    inboxes = {topic: bus.subscribe(topic, robot="r1") for topic in (RANGES, ODOMETRY)}
    started()
    assert drive.until(lambda: base.motion == AHEAD)
    assert drive.seq > 0
    for inbox in inboxes.values():
        assert wait_until(lambda inbox=inbox: inbox.take_all() != [], SOON_S)
    header = base.heard[-1][2].header
    assert header.frame_id == "base_link"
    assert header.stamp.sec + header.stamp.nanosec / 1e9 == pytest.approx(
        base.heard[-1][1] + 4_000.0, abs=0.5
    )


def test_the_base_stands_soon_after_the_last_velocity_and_is_left_alone_then(robot, started, drive):
    base = robot(TWIST)
    started()
    assert drive.until(lambda: base.motion == AHEAD)
    began_s = time.monotonic()
    assert base.is_told(STAND)
    stood_s = next(at_s for motion, at_s, _ in base.heard if motion == STAND and at_s > began_s)
    last_s = max(at_s for motion, at_s, _ in base.heard if motion == AHEAD)
    assert stood_s - began_s < 2.0
    assert stood_s - last_s < 0.5
    assert wait_until(lambda: time.monotonic() - base.heard[-1][1] > 1.5, SOON_S)


@ZENOH
def test_a_base_that_wants_the_other_type_is_named_and_told_nothing(robot, started, drive):
    base = robot(TWIST)
    process = started(velocity={"topic": "/cmd_vel", "type": TWIST_STAMPED})
    named = f"/cmd_vel: {TWIST_STAMPED} expected, but it is subscribed to by /robot as {TWIST}"
    assert drive.until(lambda: named in process.log)
    assert base.heard == []


@ZENOH
def test_while_the_scan_is_nan_the_robot_stands_and_the_reason_is_told(robot, started, drive):
    base = robot(TWIST)
    process = started()
    assert drive.until(lambda: base.motion == AHEAD)
    base.ranges_m = np.full(360, np.nan)
    assert drive.until(lambda: base.motion == STAND)
    assert "/scan: 0 of 360 readings are some" in process.log
    base.ranges_m = np.full(360, 3.0)
    assert drive.until(lambda: base.motion == AHEAD)


@ZENOH
def test_a_topic_of_another_type_is_named(join, started):
    join("lidar").publisher("/scan", "sensor_msgs/msg/Imu")
    process = started()
    assert process.says(
        "/scan: sensor_msgs/msg/LaserScan expected, but it is published by /lidar as sensor_msgs"
    )


@ZENOH
def test_an_emergency_stop_stands_whatever_drive_says(robot, started, drive, bus):
    base = robot(TWIST)
    stops, stands = bus.publisher(ESTOP_STATE, robot="r1"), bus.subscribe(ROBOT_ESTOP_STATE, robot="r1")
    started()
    assert drive.until(lambda: base.motion == AHEAD)
    numbers = itertools.count(1)

    def engaged(engage):
        stops.put(EStopState(seq=next(numbers) if engage else 1_000, robot="r1", engaged=engage, who="anna"))
        return any(state.engaged == engage for state in stands.take_all())

    assert wait_until(lambda: engaged(True), SOON_S)
    assert drive.until(lambda: base.motion == STAND)
    heard, seq = len(base.heard), drive.seq
    assert drive.until(lambda: drive.seq > seq)
    assert all(motion == STAND for motion, _, _ in base.heard[heard:])
    assert wait_until(lambda: engaged(False), SOON_S)
    assert drive.until(lambda: base.motion == AHEAD)


@ZENOH
def test_a_velocity_for_no_frame_of_this_robot_moves_nothing(robot, started, drive):
    base = robot(TWIST)
    process = started()
    assert drive.until(lambda: base.motion == AHEAD)
    assert base.is_told(STAND)

    def refused():
        drive.says(seq=10_000_000)
        return "a velocity for frame 10000000, which did not go out" in process.log

    assert wait_until(refused, SOON_S)
    assert base.motion == STAND


@ZENOH
def test_a_robots_file_that_is_wrong_ends_it_with_one_line(start):
    process = start("services.ros", scan={"topic": "scan"})
    assert process.popen.wait(SOON_S) == 1
    assert process.log.startswith("ros: ")
    assert "scan.topic" in process.log
    assert process.log.count("\n") == 1


def test_ended_by_a_signal_it_leaves_the_base_standing(robot, started, drive):
    base = robot(TWIST)
    process = started()
    assert drive.until(lambda: base.motion == AHEAD)
    process.popen.terminate()
    assert base.is_told(STAND)
    assert process.popen.wait(SOON_S) == 0
