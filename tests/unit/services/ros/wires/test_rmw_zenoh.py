"""Forms as ros2/rmw_zenoh has them: docs/design.md and its tests of liveliness_utils."""

import struct

import pytest
import xxhash

from services.ros.wires.codec import Codec
from services.ros.wires.rmw_zenoh import RmwZenohNames
from services.ros.wires.wire import SENSOR, URGENT, Endpoint, Quality

HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
STRING = "std_msgs/msg/String"
OURS = RmwZenohNames(Codec("jazzy"), 3, "topnav", "abc1")
THEIRS = RmwZenohNames(Codec("jazzy"), 3, "base", "ffe2")


def test_keys_of_publishers_are_exact_and_of_subscribers_take_any_hash():
    assert OURS.data_key("/chatter", STRING) == f"3/chatter/std_msgs::msg::dds_::String_/{HASH}"
    assert OURS.heard_key("/ns/chatter", STRING) == "3/ns/chatter/std_msgs::msg::dds_::String_/*"


def test_humbles_keys_say_that_there_is_no_hash():
    names = RmwZenohNames(Codec("humble"), 0, "topnav", "abc1")
    assert names.data_key("/chatter", STRING).endswith("String_/TypeHashNotSupported")


def test_tokens_name_the_node_and_each_endpoint():
    assert OURS.node_token() == "@ros2_lv/3/abc1/0/0/NN/%/%/topnav"
    assert OURS.token(7, "MP", "/ns/chatter", STRING, Quality(depth=10)) == (
        f"@ros2_lv/3/abc1/0/7/MP/%/%/topnav/%ns%chatter/std_msgs::msg::dds_::String_/{HASH}/::,10:,:,:,,"
    )


@pytest.mark.parametrize(
    ("quality", "ends"),
    [(SENSOR, "/2::,1:,:,:,,"), (URGENT, "/::,1:,:,:,,"), (Quality(depth=42), "/::,:,:,:,,")],
)
def test_qualities_are_told_where_they_differ_from_the_default(quality, ends):
    assert OURS.token(1, "MS", "/scan", "sensor_msgs/msg/LaserScan", quality).endswith(ends)


def test_a_token_of_somebody_else_tells_role_topic_node_and_type():
    token = THEIRS.token(2, "MS", "/ns/cmd_vel", "geometry_msgs/msg/Twist", SENSOR)
    assert OURS.read_token(token) == ("MS", "/ns/cmd_vel", Endpoint("/base", "geometry_msgs/msg/Twist"))
    assert THEIRS.read_token(token) is None  # its own


@pytest.mark.parametrize(
    "key",
    ["", "@ros2_lv/3/ffe2/0/0/NN/%/%/base", "@ros2_lv/3", "a/" * 40, "@/ffe2/@ros2_lv/MP/scan/x/:1:0:0,1"],
)
def test_other_keys_are_no_endpoints(key):
    assert OURS.read_token(key) is None


def test_nodes_below_a_namespace_are_named_in_full():
    token = (
        f"@ros2_lv/3/ff/0/2/MP/%/%robots%r1/lidar/%scan/sensor_msgs::msg::dds_::LaserScan_/{HASH}/::,:,:,:,,"
    )
    assert OURS.read_token(token) == (
        "MP",
        "/scan",
        Endpoint("/robots/r1/lidar", "sensor_msgs/msg/LaserScan"),
    )


def test_an_attachment_is_33_bytes_number_time_length_and_gid():
    gid = bytes(range(16))
    attachment = OURS.attachment(1, 2, gid)
    assert len(attachment) == 33
    assert struct.unpack("<qqB", attachment[:17]) == (1, 2, 16)
    assert attachment[17:] == gid


def test_a_gid_is_the_hash_of_the_token_low_half_first():
    token = OURS.token(1, "MP", "/chatter", STRING, Quality())
    low, high = struct.unpack("<QQ", OURS.gid(token))
    assert (high << 64) | low == xxhash.xxh3_128_intdigest(token.encode())


def test_an_answer_repeats_number_and_gid_of_its_request():
    request = THEIRS.attachment(9, 100, b"g" * 16)
    assert OURS.answer_attachment(request, 200) == OURS.attachment(9, 200, b"g" * 16)


@pytest.mark.parametrize("request_attachment", [None, b"", b"x" * 32, b"x" * 77, b"\x00" * 33])
def test_a_request_whose_attachment_cannot_be_read_gets_no_answer(request_attachment):
    assert OURS.answer_attachment(request_attachment, 0) is None
