"""Against what real ROS 2 (rclpy 9.1.2, Fast DDS) says of itself: golden.json is written by real_ros.py."""

import json
from pathlib import Path

import pytest

from services.ros.wires.codec import NO_HASH, Codec, CodecError, dds_name, ros_name
from tests.ros_messages import plain

GOLDEN = json.loads(Path(__file__).with_name("golden.json").read_text(encoding="utf-8"))
CODECS = {name: Codec(name) for name in ("humble", "jazzy", "kilted")}


@pytest.mark.parametrize("kind", GOLDEN["hashes"])
@pytest.mark.parametrize("distribution", ["jazzy", "kilted"])
def test_type_hashes_are_those_of_real_ros(distribution, kind):
    assert CODECS[distribution].type_hash(kind) == GOLDEN["hashes"][kind]


def test_humble_has_no_hashes():
    assert CODECS["humble"].type_hash("std_msgs/msg/String") == NO_HASH


@pytest.mark.parametrize("kind", GOLDEN["cdr"])
@pytest.mark.parametrize("distribution", CODECS)
def test_what_real_ros_wrote_comes_back_with_the_same_values_after_we_wrote_it(distribution, kind):
    codec, theirs = CODECS[distribution], bytes.fromhex(GOLDEN["cdr"][kind])
    message = codec.decode(kind, theirs)
    ours = codec.encode(kind, message)
    assert plain(codec.decode(kind, ours)) == plain(message)
    assert ours[:4] == theirs[:4] == b"\x00\x01\x00\x00"
    assert 0 <= len(theirs) - len(ours) < 4  # Fast CDR fills up to four bytes
    differing = [at for at, (a, b) in enumerate(zip(ours, theirs, strict=False)) if a != b]
    assert all(ours[at] == 0 for at in differing)  # padding, which is arbitrary


def golden(kind):
    return CODECS["jazzy"].decode(kind, bytes.fromhex(GOLDEN["cdr"][kind]))


def test_values_are_those_that_real_ros_was_given():
    scan = golden("sensor_msgs/msg/LaserScan")
    assert (scan.header.stamp.sec, scan.header.stamp.nanosec, scan.header.frame_id) == (12, 345, "base_link")
    assert scan.ranges.tolist() == [1.0, 2.5, float("inf")]
    twist = golden("geometry_msgs/msg/TwistStamped").twist
    assert (twist.linear.x, twist.linear.y, twist.angular.z) == (0.25, -0.5, 1.5)


START = b"\x00\x01\x00\x00"


@pytest.mark.parametrize(
    "payload",
    [b"", b"\x00", START, START + b"\xff" * 4, START + b"\x02\x00\x00\x00\xff\x00", b"\xff" * 40],
)
def test_bytes_that_are_no_string_are_named(payload):
    with pytest.raises(CodecError, match=r"std_msgs/msg/String expected, \d+ bytes are none"):
        CODECS["jazzy"].decode("std_msgs/msg/String", payload)


def test_a_message_of_another_type_is_named():
    twist = bytes.fromhex(GOLDEN["cdr"]["geometry_msgs/msg/Twist"])
    with pytest.raises(CodecError, match="LaserScan expected"):
        CODECS["jazzy"].decode("sensor_msgs/msg/LaserScan", twist)


def test_made_messages_are_zero_but_for_what_is_given():
    message = CODECS["jazzy"].make("nav_msgs/msg/Odometry", child_frame_id="base")
    assert message.child_frame_id == "base"
    assert message.pose.covariance.tolist() == [0.0] * 36
    with pytest.raises(TypeError, match="no field colour"):
        CODECS["jazzy"].make("nav_msgs/msg/Odometry", colour=1)


def test_names_of_types_both_ways():
    assert dds_name("sensor_msgs/msg/LaserScan") == "sensor_msgs::msg::dds_::LaserScan_"
    assert ros_name("sensor_msgs::msg::dds_::LaserScan_") == "sensor_msgs/msg/LaserScan"
    assert ros_name("something else") == "something else"
