"""rmw_zenoh's protocol by somebody else: zenoh-ros2-sdk hears us, we hear it, and it calls our service."""

import json
import subprocess
from pathlib import Path

import numpy as np
import pytest

from services.ros.conversions.twist import Motion, twist_bytes
from services.ros.robot_file import WireChoice
from services.ros.wires.wire import Endpoint
from shared.bus import wait_until
from tests.integration.ros.conftest import ROS_PYTHON, SOON_S
from tests.ros_messages import CODEC, SCAN, TWIST_STAMPED

PROGRAM = Path(__file__).with_name("other_implementation.py")
TRIGGER = "std_srvs/srv/Trigger"
MOTION = Motion(0.25, -0.5, 1.5)


def has_it() -> bool:
    """Whether the Python with ROS has the other implementation, too."""
    command = [str(ROS_PYTHON), "-c", "import zenoh_ros2_sdk"]
    return ROS_PYTHON.exists() and subprocess.run(command, capture_output=True, check=False).returncode == 0


def stands(_request, reply):
    response = CODEC.make(f"{TRIGGER}_Response", success=True, message="stands")
    reply(CODEC.encode(f"{TRIGGER}_Response", response))


@pytest.fixture
def lines(choice: WireChoice, tmp_path):
    """What the other implementation says, while it is up."""
    if not has_it():
        pytest.skip(f"no zenoh-ros2-sdk in {ROS_PYTHON}: deploy/setup/ros.sh installs it")
    said, port = tmp_path / "said.jsonl", choice.endpoint.rpartition(":")[2]
    share = ROS_PYTHON.parents[1] / "share"
    command = [ROS_PYTHON, PROGRAM, port, str(choice.domain), share, CODEC.type_hash(TRIGGER)]
    with said.open("wb") as file:
        other = subprocess.Popen([str(word) for word in command], stdin=subprocess.PIPE, stdout=file)
    yield lambda: [json.loads(line) for line in said.read_text(encoding="utf-8").splitlines()]
    other.kill()
    other.communicate()


@pytest.mark.parametrize("choice", ["rmw_zenoh"], indirect=True)
def test_velocities_scans_services_and_who_is_there_agree(join, lines):
    ours, came = join("topnav"), []
    ours.subscribe("/scan", SCAN, lambda payload, _at_s: came.append(CODEC.decode(SCAN, payload)))
    ours.serve("/topnav/stop", TRIGGER, stands)
    say = ours.publisher("/cmd_vel", TWIST_STAMPED)

    def all_heard():
        say(twist_bytes(CODEC, TWIST_STAMPED, MOTION, "base_link", 12.5))
        return came and {"stopped": True, "message": "stands"} in lines() and len(lines()) > 1

    assert wait_until(all_heard, SOON_S), lines()
    assert {"frame": "base_link", "ahead": 0.25, "left": -0.5, "turn": 1.5} in lines()
    assert (came[-1].header.frame_id, came[-1].header.stamp.sec) == ("laser", 7)
    np.testing.assert_array_equal(came[-1].ranges, np.arange(1.0, 13.0))
    assert [one.kind for one in ours.subscribers("/cmd_vel")] == [TWIST_STAMPED]
    assert all(isinstance(one, Endpoint) and one.kind == SCAN for one in ours.publishers("/scan"))
