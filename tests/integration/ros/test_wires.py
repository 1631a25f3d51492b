"""Two nodes on each wire: what is said is heard, who is there is known, services are answered."""

import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
import zenoh

from services.ros.base_link import BaseLink
from services.ros.conversions.twist import STAND, Motion, motion_of, twist_bytes
from services.ros.robot_file import VelocityTopic, WireChoice
from services.ros.wires.opening import Interpreter, open_wire
from services.ros.wires.rmw_zenoh import RmwZenohNames
from services.ros.wires.wire import URGENT, WireError
from shared.bus import wait_until
from tests.integration.ros.conftest import ROS_PYTHON, SOON_S
from tests.ros_messages import CODEC, SCAN, TWIST, scan

TRIGGER = "std_srvs/srv/Trigger"
CALL = """
import rclpy
from std_srvs.srv import Trigger
rclpy.init()
node = rclpy.create_node("asks")
client = node.create_client(Trigger, "/topnav/stop")
assert client.wait_for_service(20)
future = client.call_async(Trigger.Request())
rclpy.spin_until_future_complete(node, future, timeout_sec=20)
print(future.result().message)
"""


def stands(_request, reply):
    response = CODEC.make(f"{TRIGGER}_Response", success=True, message="stands")
    reply(CODEC.encode(f"{TRIGGER}_Response", response))


def test_what_one_node_says_another_hears(join):
    ours, theirs, came = join("topnav"), join("base"), []
    theirs.subscribe("/cmd_vel", TWIST, lambda payload, _at_s: came.append(payload))
    say = ours.publisher("/cmd_vel", TWIST, URGENT)
    motion = Motion(0.25, -0.5, 1.5)

    def heard():
        say(twist_bytes(CODEC, TWIST, motion, "", None))
        return bool(came)

    assert wait_until(heard, SOON_S)
    assert motion_of(CODEC.decode(TWIST, came[0]), TWIST) == motion


def test_each_sees_what_the_other_publishes_and_subscribes_to_until_it_leaves(join):
    ours, theirs = join("topnav"), join("base")
    for wire in (ours, theirs):
        wire.subscribe("/cmd_vel", TWIST, lambda _payload, _at_s: None)
    theirs.publisher("/scan", SCAN)
    ours.subscribe("/scan", SCAN, lambda _payload, _at_s: None)
    assert wait_until(lambda: [e.kind for e in ours.subscribers("/cmd_vel")] == [TWIST], SOON_S)
    assert wait_until(lambda: [e.kind for e in ours.publishers("/scan")] == [SCAN], SOON_S)
    assert ours.publishers("/cmd_vel") == []
    theirs.close()
    assert wait_until(lambda: not ours.subscribers("/cmd_vel") and not ours.publishers("/scan"), SOON_S)


@pytest.mark.parametrize("choice", ["rmw_zenoh", "bridge"], indirect=True)
def test_a_service_is_answered_with_the_number_and_gid_of_its_request(join, choice, router_endpoint):
    join("topnav").serve("/topnav/stop", TRIGGER, stands)
    names = RmwZenohNames(CODEC, choice.domain, "asks", "abc")
    attachment = names.attachment(5, 1, b"g" * 16) if choice.kind == "rmw_zenoh" else None
    key = names.data_key("/topnav/stop", TRIGGER) if choice.kind == "rmw_zenoh" else "topnav/stop"
    config = zenoh.Config.from_json5(f'{{mode: "client", connect: {{endpoints: ["{router_endpoint}"]}}}}')
    with zenoh.open(config) as session:

        def asked(with_attachment):
            return list(session.get(key, payload=b"\x00\x01\x00\x00\x00", attachment=with_attachment))

        assert wait_until(lambda: bool(asked(attachment)), SOON_S)
        (answer,) = asked(attachment)
        assert CODEC.decode(f"{TRIGGER}_Response", answer.ok.payload.to_bytes()).message == "stands"
        if choice.kind == "rmw_zenoh":
            assert answer.ok.attachment.to_bytes()[:8] == attachment[:8]
            assert answer.ok.attachment.to_bytes()[-16:] == b"g" * 16
            assert asked(None) == []


@pytest.mark.parametrize("choice", ["rclpy"], indirect=True)
def test_a_client_of_rclpy_gets_its_answer(join, choice):
    join("topnav").serve("/topnav/stop", TRIGGER, stands)
    environment = {**os.environ, "ROS_DOMAIN_ID": str(choice.domain)}
    command = [str(ROS_PYTHON), "-c", CALL]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=90, check=False)
    assert run.stdout.strip() == "stands", run.stderr


@pytest.mark.parametrize("choice", ["rclpy"], indirect=True)
def test_a_side_car_that_dies_is_told_and_one_of_a_closed_wire_ends(join):
    wire = join("topnav")
    wire.require_up()
    wire._process.kill()

    def down():
        try:
            wire.require_up()
        except WireError as error:
            return "the process of rclpy ended" in str(error)
        return False

    assert wait_until(down, SOON_S)


@pytest.mark.parametrize("choice", ["rclpy"], indirect=True)
def test_a_last_word_to_stand_is_heard_though_the_side_car_was_held_up(join):
    """By a burst of load it does not run for a while, and is told to end meanwhile."""
    ours, theirs, came = join("topnav"), join("base"), []
    theirs.subscribe("/cmd_vel", TWIST, lambda payload, _at_s: came.append(payload))
    ours.subscribe("/scan", SCAN, lambda _payload, _at_s: None)
    base, scans = (
        BaseLink(ours, CODEC, VelocityTopic(topic="/cmd_vel", type=TWIST)),
        theirs.publisher("/scan", SCAN),
    )

    def moves():
        base.send(Motion(0.5, 0.0, 0.0), None)
        return bool(came)

    assert wait_until(moves, SOON_S)
    ours._process.send_signal(signal.SIGSTOP)
    scans(CODEC.encode(SCAN, scan(np.full(360, 3.0), 1.0)))
    base.send(STAND, None)
    going_on = threading.Timer(2 * URGENT.lives_s, ours._process.send_signal, [signal.SIGCONT])
    going_on.start()
    ours.close()
    assert wait_until(lambda: motion_of(CODEC.decode(TWIST, came[-1]), TWIST) == STAND, SOON_S)
    going_on.join()


def test_a_python_without_rclpy_or_none_at_all_is_named():
    choice = WireChoice(kind="rclpy")
    with pytest.raises(WireError, match="ROS2_PYTHON names one with rclpy"):
        open_wire(choice, CODEC, "topnav", Interpreter("/nowhere/python"))
    with pytest.raises(WireError, match="has no rclpy"):
        open_wire(choice, CODEC, "topnav", Interpreter(sys.executable))


@pytest.mark.parametrize("kind", ["rmw_zenoh", "bridge"])
def test_a_router_that_is_not_there_is_named(kind, free_port):
    choice = WireChoice(kind=kind, endpoint=f"tcp/127.0.0.1:{free_port()}")
    with pytest.raises(WireError, match=r"no Zenoh router of the robot at tcp/127\.0\.0\.1"):
        open_wire(choice, CODEC, "topnav", Interpreter("python3"))
