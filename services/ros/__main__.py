"""Entry point: `python -m services.ros`."""

import sys
from functools import partial

from services.ros.robot_file import RobotFileError, load_robot_file
from services.ros.service import run
from services.ros.settings import RosSettings
from services.ros.wires.wire import WireError
from shared.lifecycle import run_service
from shared.sole_robot import TakenError


def main() -> None:
    """Run the ROS service until a signal; a bad robot's file or a taken name ends it with one line."""
    settings = RosSettings.of_service("ros")
    try:
        file = load_robot_file(settings.robot_file)
    except RobotFileError as error:
        sys.exit(f"ros: {error}")
    try:
        run_service("ros", settings, partial(run, settings, file))
    except (TakenError, WireError) as error:
        sys.exit(f"ros: {error}")


if __name__ == "__main__":
    main()
