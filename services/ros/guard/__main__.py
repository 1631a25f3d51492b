"""Entry point: `python -m services.ros.guard`, on the robot's own computer."""

import logging
import sys

from services.ros.guard.service import run
from services.ros.robot_file import RobotFileError, load_robot_file
from services.ros.settings import RosSettings
from services.ros.wires.wire import WireError
from shared.lifecycle import configure_logging, stop_on_signals

log = logging.getLogger(__name__)


def main() -> None:
    """Guard the base until a signal; a file without a guard ends it with one line."""
    settings = RosSettings.of_service("robot-guard")
    try:
        file = load_robot_file(settings.robot_file)
    except RobotFileError as error:
        sys.exit(f"robot-guard: {error}")
    if file.guard is None:
        sys.exit(f"robot-guard: {settings.robot_file}: a section 'guard' expected, there is none")
    configure_logging("robot-guard", settings.log_level)
    stop = stop_on_signals()
    try:
        run(settings, file, file.guard, stop)
    except WireError as error:
        sys.exit(f"robot-guard: {error}")
    log.info("stopped")


if __name__ == "__main__":
    main()
