"""Forms as eclipse-zenoh/zenoh-plugin-ros2dds has them (src/liveliness_mgt.rs)."""

import pytest

from services.ros.wires.bridge import BridgeNames
from services.ros.wires.wire import REPORT, SENSOR, URGENT, Endpoint

TWIST = "geometry_msgs/msg/Twist"
OURS, NAMED = BridgeNames("abc1"), BridgeNames("abc1", "/bot1")


def test_a_key_is_the_name_and_the_bridges_namespace_before_it():
    assert OURS.data_key("/cmd_vel", TWIST) == OURS.heard_key("/cmd_vel", TWIST) == "cmd_vel"
    assert NAMED.data_key("/base/cmd_vel", TWIST) == "bot1/base/cmd_vel"


def test_tokens_carry_type_and_qualities():
    assert OURS.node_token() == "@/abc1/@ros2_lv"
    assert OURS.token(1, "MP", "/base/cmd_vel", TWIST, URGENT) == (
        "@/abc1/@ros2_lv/MP/base§cmd_vel/geometry_msgs§msg§Twist/:1:0:0,1"
    )
    assert OURS.token(1, "MS", "/scan", "sensor_msgs/msg/LaserScan", SENSOR).endswith("/:0:0:0,1")
    assert OURS.token(1, "SS", "/topnav/stop", "std_srvs/srv/Trigger", REPORT) == (
        "@/abc1/@ros2_lv/SS/topnav§stop/std_srvs§srv§Trigger"
    )


@pytest.mark.parametrize("names", [OURS, NAMED])
def test_a_bridges_token_tells_role_topic_and_type(names):
    bridge = BridgeNames("ffe2", names.namespace)
    token = bridge.token(1, "MS", "/base/cmd_vel", TWIST, SENSOR)
    assert names.read_token(token) == ("MS", "/base/cmd_vel", Endpoint("bridge ffe2", TWIST))
    assert bridge.read_token(token) is None


@pytest.mark.parametrize("key", ["", "@/ffe2/@ros2_lv", "@/ffe2/@ros2_lv/MP", "x/" * 20])
def test_other_keys_are_no_endpoints(key):
    assert OURS.read_token(key) is None


def test_samples_carry_no_attachment_and_requests_need_none():
    assert OURS.attachment(1, 2, b"") is None
    assert OURS.answer_attachment(b"x", 0) is None
    assert not OURS.answers_need_attachment
