"""A robot by another implementation of rmw_zenoh's protocol, zenoh-ros2-sdk: PORT DOMAIN SHARE HASH.

Run by a Python that has it. Publishes /scan, tells what /cmd_vel says and /topnav/stop answers, as JSON.
SHARE has the definitions of the messages, which it would clone from GitHub otherwise; HASH is the service's.
"""

import json
import math
import sys
import threading
from typing import Any

import numpy as np
from zenoh_ros2_sdk import ROS2Publisher, ROS2ServiceClient, ROS2Subscriber
from zenoh_ros2_sdk.message_registry import get_message_class, get_registry

PERIOD_S = 0.1
EMPTY, RESPONSE = "uint8 structure_needs_at_least_one_member", "bool success\nstring message"
"""It reads no service file with an empty request; on the wire rosidl's own member stands for nothing."""
RANGES_M, NOTHING = np.arange(1.0, 13.0, dtype=np.float32), np.zeros(0, np.float32)


def say(**facts: Any) -> None:
    """One line."""
    sys.stdout.write(json.dumps(facts) + "\n")
    sys.stdout.flush()


def told(message: Any) -> None:
    """What the base hears."""
    twist = message.twist
    say(frame=message.header.frame_id, ahead=twist.linear.x, left=twist.linear.y, turn=twist.angular.z)


def main() -> None:
    """Be the robot until standard input ends."""
    port, domain, share = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    get_registry(share)
    there: dict[str, Any] = {"domain_id": domain, "router_port": port}
    ROS2Subscriber("/cmd_vel", "geometry_msgs/msg/TwistStamped", told, **there)
    stamp = get_message_class("builtin_interfaces/msg/Time")(sec=7, nanosec=5)
    header = get_message_class("std_msgs/msg/Header")(stamp=stamp, frame_id="laser")
    scan = ROS2Publisher("/scan", "sensor_msgs/msg/LaserScan", **there)
    stop = ROS2ServiceClient(
        "/topnav/stop", "std_srvs/srv/Trigger", EMPTY, RESPONSE, type_hash=sys.argv[4], **there
    )

    def ask() -> None:
        while (answer := stop.call()) is None:
            pass
        say(stopped=answer.success, message=answer.message)

    threading.Thread(target=ask, daemon=True).start()
    ended = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
    while not ended.wait(PERIOD_S):
        scan.publish(
            header=header, angle_min=0.0, angle_max=math.tau, angle_increment=math.tau / 12,
            time_increment=0.0, scan_time=PERIOD_S, range_min=0.1, range_max=12.0, ranges=RANGES_M,
            intensities=NOTHING,
        )  # fmt: skip


if __name__ == "__main__":
    main()
