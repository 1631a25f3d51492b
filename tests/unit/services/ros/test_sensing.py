"""What the service says of topics that are as they should be, and of those that are not."""

import threading
from dataclasses import dataclass, field

import numpy as np
import pytest

from services.ros.robot_file import RobotFile
from services.ros.sensing import TROUBLE_S, Sensing, silence
from services.ros.wires.wire import Endpoint
from shared.messages.body import Battery, Imu, Odometry
from shared.messages.sensors import Frame, Ranges
from tests.ros_messages import (
    BATTERY,
    CODEC,
    IMU,
    ODOMETRY,
    PICTURE,
    SCAN,
    TWIST,
    jpeg,
    odometry,
    room,
    scan,
    stamped,
)

OFFSET_S = 5_000.0  # the robot's clock is far off ours

FILE = RobotFile.model_validate(
    {
        "name": "robot", "wire": {"kind": "bridge"},
        "camera": {"topic": "/picture"}, "scan": {"topic": "/scan", "frame": "laser"},
        "imu": {"topic": "/imu"}, "odometry": {"topic": "/odom"}, "battery": {"topic": "/battery"},
        "velocity": {"topic": "/cmd_vel"}, "limits": {"forward_mps": 0.5, "turn_radps": 1.0},
    }
)  # fmt: skip


@dataclass
class Robot:
    """The robot's side of the wire, and what the service counted."""

    told: list = field(default_factory=list)
    heard: dict = field(default_factory=dict)
    there: dict = field(default_factory=dict)
    now_s: float = 10.0

    def __post_init__(self):
        count = lambda kind, text: self.told.append((kind, text))  # noqa: E731
        self.sensing = Sensing(FILE, CODEC, "r1", count, self.now_s, wall_ns=1_000_000_000_000)
        self.sensing.subscribe(self, threading.Event())

    def subscribe(self, topic, kind, deliver, _quality=None):
        self.heard[topic] = (kind, deliver)

    def publishers(self, topic):
        return self.there.get(topic, [])

    def says(self, topic, kind, message):
        self.heard[topic][1](CODEC.encode(kind, message), self.now_s)
        return self.sensing.take(self.now_s)

    def scans(self, ranges=None, late_s=0.0, frame="laser"):
        at_s = self.now_s + OFFSET_S - late_s
        return self.says("/scan", SCAN, scan(np.full(360, 3.0) if ranges is None else ranges, at_s, frame))

    @property
    def lines(self):
        return [text for _, text in self.told]


@pytest.fixture
def robot():
    return Robot()


def test_every_topic_of_the_file_is_heard_with_its_type(robot):
    kinds = {topic: kind for topic, (kind, _) in robot.heard.items()}
    assert kinds == {"/odom": ODOMETRY, "/picture": PICTURE, "/scan": SCAN, "/imu": IMU, "/battery": BATTERY}


def test_each_becomes_a_message_of_topnav(robot):
    (ranges,) = robot.scans()
    assert isinstance(ranges, Ranges)
    assert ranges.distances_m == pytest.approx((3.0,) * 12)
    at_s = robot.now_s + OFFSET_S
    picture = stamped(PICTURE, at_s)
    picture.data = np.frombuffer(jpeg(), np.uint8)
    (frame,) = robot.says("/picture", PICTURE, picture)
    assert isinstance(frame, Frame)
    assert frame.seq == 1
    assert isinstance(robot.says("/odom", ODOMETRY, odometry(at_s=at_s))[0], Odometry)
    imu = stamped(IMU, at_s)
    imu.linear_acceleration.z = 9.81
    assert isinstance(robot.says("/imu", IMU, imu)[0], Imu)
    assert isinstance(robot.says("/battery", BATTERY, stamped(BATTERY, at_s))[0], Battery)
    assert robot.told == []
    assert robot.sensing.problem(robot.now_s) == ""


def test_only_the_newest_of_a_topic_counts(robot):
    robot.heard["/scan"][1](b"old", robot.now_s)
    assert len(robot.scans()) == 1
    assert robot.sensing.take(robot.now_s) == []


def test_stamps_are_by_this_machines_clock_whatever_the_robots_says(robot):
    robot.scans()
    robot.now_s += 0.5
    (ranges,) = robot.scans(late_s=0.2)
    assert ranges.stamp_ns / 1e9 == pytest.approx(1_000.0 + 0.3)


@pytest.mark.parametrize(
    ("payload", "named"),
    [
        (CODEC.encode(TWIST, CODEC.make(TWIST)), "/scan: sensor_msgs/msg/LaserScan expected"),
        (b"", "/scan: sensor_msgs/msg/LaserScan expected, 0 bytes are none"),
        (CODEC.encode(SCAN, scan(np.full(360, np.nan), frame="laser")), "/scan: 0 of 360 readings are some"),
        (
            CODEC.encode(SCAN, scan(np.full(360, 3.0), frame="map")),
            "/scan: frame 'laser' expected, got 'map'",
        ),
    ],
)
def test_a_scan_that_cannot_be_used_is_named_and_the_robot_stands_for_a_while(robot, payload, named):
    robot.heard["/scan"][1](payload, robot.now_s)
    assert robot.sensing.take(robot.now_s) == []
    assert named in robot.lines[0]
    assert "\n" not in robot.lines[0]
    assert robot.sensing.problem(robot.now_s) == robot.lines[0]
    assert robot.sensing.problem(robot.now_s + TROUBLE_S) == ""


def test_an_imu_that_cannot_be_used_is_named_and_stops_nothing(robot):
    imu = stamped(IMU, robot.now_s + OFFSET_S)
    imu.linear_acceleration.z = -9.81
    assert robot.says("/imu", IMU, imu) == []
    assert "/imu: gravity points up" in robot.lines[0]
    assert robot.sensing.problem(robot.now_s) == ""


@pytest.mark.parametrize("jump_s", [60.0, -60.0])
def test_a_jump_of_the_robots_clock_is_named_and_the_robot_stands(robot, jump_s):
    for _ in range(10):
        robot.scans()
        robot.now_s += 0.1
    assert robot.told == []
    for _ in range(4):
        robot.now_s += 0.1
        robot.scans(late_s=-jump_s)
    assert any(f"/scan: the robot's clock jumped by {jump_s:+.1f} s" in line for line in robot.lines)
    assert robot.sensing.problem(robot.now_s) != ""
    robot.now_s += TROUBLE_S
    assert len(robot.scans(late_s=-jump_s)) == 1
    assert robot.sensing.problem(robot.now_s) == ""


def turn(robot, mirrored):
    for step in range(40):
        robot.now_s += 0.1
        yaw_rad = 0.1 * step
        robot.says("/odom", ODOMETRY, odometry(yaw_rad, at_s=robot.now_s + OFFSET_S))
        ranges_m = room(yaw_rad)
        robot.scans(ranges_m[-np.arange(360) % 360] if mirrored else ranges_m)


def test_a_mirrored_scanner_is_named_once_the_robot_turns_and_nothing_moves(robot):
    turn(robot, mirrored=True)
    assert "/scan: scans turn against /odom: the scanner is mirrored" in robot.sensing.problem(robot.now_s)


def test_a_scanner_that_is_not_mirrored_is_not_named(robot):
    turn(robot, mirrored=False)
    assert robot.sensing.problem(robot.now_s) == ""


def test_blind_sectors_are_named_once_by_their_direction(robot):
    ranges = np.full(360, 3.0)
    ranges[136:225] = np.nan
    for _ in range(3):
        robot.scans(ranges)
    assert robot.lines == ["/scan: blind at (degrees): 150, 180, 210; taken for occupied"]


def test_what_came_while_the_process_stood_still_is_thrown_away(robot):
    robot.sensing.ignore(robot.now_s + 0.2)
    assert robot.scans() == []
    robot.now_s += 0.2
    assert len(robot.scans()) == 1


def test_the_time_of_commands_is_the_robots(robot):
    assert robot.sensing.robot_time_s(robot.now_s) is None
    robot.scans()
    assert robot.sensing.robot_time_s(robot.now_s) == pytest.approx(robot.now_s + OFFSET_S)


def test_silent_topics_are_named_with_the_reason(robot):
    robot.there = {"/scan": [Endpoint("/lidar", IMU)], "/picture": [Endpoint("/camera", PICTURE)]}
    robot.sensing.tell_silence(robot, robot.now_s + 1.0)
    assert robot.told == []
    robot.sensing.tell_silence(robot, robot.now_s + 3.0)
    assert f"/scan: {SCAN} expected, but it is published by /lidar as {IMU}" in robot.lines
    assert "/picture: /camera publishes it, but nothing comes" in robot.lines
    assert "/odom: nobody publishes it" in robot.lines
    assert silence("/odom", ODOMETRY, robot) in robot.lines
