"""The ROS service of the Compose file, under the launcher: on the open bus and on the secured one."""

from contextlib import closing

import pytest
import yaml

from services.launcher.processes.supervisor import Launcher
from services.ros.robot_file import WireChoice
from services.ros.wires.opening import Interpreter, open_wire
from shared.bus import open_bus, wait_until
from shared.topics import RANGES
from tests.integration.ros.conftest import CODEC, SOON_S, Robot

START_S = 90.0

pytestmark = pytest.mark.usefixtures("patient_sessions")


@pytest.mark.parametrize("secure", [False, True], ids=["open", "secured"])
def test_a_robot_in_ros_is_one_of_the_stack(secure, tmp_path, router_endpoint):
    """It is alive by its token, which the router of a secured bus must let pass, and says what it senses."""
    wire = {"kind": "rmw_zenoh", "endpoint": router_endpoint}
    described = {
        "name": "test", "wire": wire, "scan": {"topic": "/scan"}, "camera": {"topic": "/picture"},
        "velocity": {"topic": "/cmd_vel"}, "limits": {"forward_mps": 0.5, "turn_radps": 1.0},
    }  # fmt: skip
    file = tmp_path / "robot.yaml"
    file.write_text(yaml.safe_dump(described), encoding="utf-8")
    node = open_wire(WireChoice(**wire), CODEC, "robot", Interpreter("python3"))
    with (
        closing(node),
        closing(Robot(node, "geometry_msgs/msg/TwistStamped")),
        Launcher(tmp_path / "data", only=["ros"], ros=str(file), secure=secure, timeout_s=START_S) as stack,
    ):
        assert set(stack.status()) == {"router", "ros"}
        with open_bus(stack.endpoint, certs=stack.certs) as bus:
            assert wait_until(lambda: bus.alive("ros") == ["ros"], SOON_S)
            ranges = bus.subscribe(RANGES, robot="r1")
            sensed = []
            assert wait_until(lambda: bool(sensed.extend(ranges.take_all()) or sensed), SOON_S)
            assert sensed[0].distances_m == pytest.approx([3.0] * 12, abs=0.1)
