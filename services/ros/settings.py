"""Settings of the ROS service, from ROS2_* variables; ROS itself has those that begin with ROS_."""

from pathlib import Path

from pydantic_settings import SettingsConfigDict

from services.ros.wires.opening import Interpreter
from shared.settings import OptionalPath, ServiceSettings


class RosSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        robot_file: describes the robot, see deploy/ROBOTS.md. python: interpreter with rclpy, for robots that
        are reached by it. setup: what the shell reads before it, as /opt/ros/jazzy/setup.bash; nothing for an
        environment of wheels. state_dir: where the robot keeps an emergency stop across restarts.
    """

    model_config = SettingsConfigDict(env_prefix="ROS2_")

    robot_file: Path = Path("deploy/robots/turtlebot4.yaml")
    python: str = "python3"
    setup: OptionalPath = None
    state_dir: Path = Path("data/robot-state")

    @property
    def interpreter(self) -> Interpreter:
        """Where rclpy is."""
        return Interpreter(self.python, self.setup)
