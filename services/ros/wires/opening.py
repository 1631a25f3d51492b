"""The wire that a robot's file asks for."""

import logging
import threading
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from services.ros.robot_file import WireChoice
from services.ros.side_car.wire import open_side_car
from services.ros.wires.bridge import BridgeNames
from services.ros.wires.codec import Codec
from services.ros.wires.rmw_zenoh import RmwZenohNames
from services.ros.wires.wire import Wire, WireError
from services.ros.wires.zenoh_wire import open_zenoh

log = logging.getLogger(__name__)

PAUSE_S = 1.0
"""Between two tries to reach the robot; chosen."""


@dataclass(frozen=True)
class Interpreter:
    """Python with rclpy, and what the shell reads before it starts; for robots that are reached by it."""

    python: str
    setup: Path | None = None


def open_wire(choice: WireChoice, codec: Codec, node: str, rclpy: Interpreter) -> Wire:
    """Join the robot's ROS graph as a node of that name.

    Raises:
        WireError: the router, the bridge or rclpy is not there.
    """
    if choice.kind == "rclpy":
        return open_side_car(rclpy.python, rclpy.setup, choice.domain, node)
    if choice.kind == "bridge":
        return open_zenoh(choice.endpoint, partial(BridgeNames, namespace=choice.namespace))
    return open_zenoh(choice.endpoint, partial(RmwZenohNames, codec, choice.domain, node))


def wait_for_wire(
    choice: WireChoice, codec: Codec, node: str, rclpy: Interpreter, stop: threading.Event
) -> Wire | None:
    """Try until the robot is there, and say every time why it is not; None once `stop` is set."""
    while not stop.is_set():
        try:
            return open_wire(choice, codec, node, rclpy)
        except WireError as error:
            log.warning("%s", error)
            stop.wait(PAUSE_S)
    return None
