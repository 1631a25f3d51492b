"""Write golden.json from a real ROS 2: run by a Python that has rclpy, as `make ros-demo` installs it.

ROS/bin/python tests/unit/services/ros/wires/real_ros.py > tests/unit/services/ros/wires/golden.json
"""

import json
import sys
from pathlib import Path


def main() -> None:
    """Hashes as the packages have them, and messages as its serialiser writes them."""
    sys.stdout.write(json.dumps({"hashes": hashes(), "cdr": cdr()}, indent=1) + "\n")


def hashes() -> dict[str, str]:
    """Type hashes of all types that topnav uses."""
    kinds = [
        "std_msgs/msg/String", "sensor_msgs/msg/CompressedImage", "sensor_msgs/msg/Image",
        "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/Imu", "sensor_msgs/msg/BatteryState",
        "nav_msgs/msg/Odometry", "geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped",
        "std_srvs/srv/Trigger",
    ]  # fmt: skip
    found = {}
    for kind in kinds:
        file = Path(sys.prefix) / "share" / f"{kind}.json"
        rows = json.loads(file.read_text(encoding="utf-8"))["type_hashes"]
        found[kind] = next(row["hash_string"] for row in rows if row["type_name"] == kind)
    return found


def cdr() -> dict[str, str]:
    """One message of each type."""
    from builtin_interfaces.msg import Time
    from geometry_msgs.msg import Twist, TwistStamped, Vector3
    from nav_msgs.msg import Odometry
    from rclpy.serialization import serialize_message
    from sensor_msgs.msg import BatteryState, CompressedImage, Image, Imu, LaserScan
    from std_msgs.msg import Header, String
    from std_srvs.srv import Trigger

    header = Header(stamp=Time(sec=12, nanosec=345), frame_id="base_link")
    twist = Twist(linear=Vector3(x=0.25, y=-0.5), angular=Vector3(z=1.5))
    scan = LaserScan(
        header=header, angle_min=-3.0, angle_max=3.0, angle_increment=0.5, range_min=0.1, range_max=12.0,
        ranges=[1.0, 2.5, float("inf")],
    )  # fmt: skip
    odometry = Odometry(header=header, child_frame_id="base_link")
    odometry.pose.pose.position.x, odometry.pose.pose.orientation.z = 1.5, 1.0
    imu = Imu(header=header)
    imu.angular_velocity.z, imu.linear_acceleration.z = 0.5, 9.81
    battery = BatteryState(
        header=header, voltage=14.5, percentage=0.5, power_supply_status=2, cell_voltage=[3.5], location="b"
    )
    messages = {
        "std_msgs/msg/String": String(data="grüße"),
        "sensor_msgs/msg/CompressedImage": CompressedImage(header=header, format="jpeg", data=b"\xff\xd8"),
        "sensor_msgs/msg/Image": Image(
            header=header, height=1, width=2, encoding="bgr8", step=6, data=bytes(range(6))
        ),
        "sensor_msgs/msg/LaserScan": scan,
        "sensor_msgs/msg/Imu": imu,
        "sensor_msgs/msg/BatteryState": battery,
        "nav_msgs/msg/Odometry": odometry,
        "geometry_msgs/msg/Twist": twist,
        "geometry_msgs/msg/TwistStamped": TwistStamped(header=header, twist=twist),
        "std_srvs/srv/Trigger_Response": Trigger.Response(success=True, message="stands"),
    }
    return {kind: serialize_message(message).hex() for kind, message in messages.items()}


if __name__ == "__main__":
    main()
