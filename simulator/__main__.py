"""Entry point: `python -m simulator`."""

import sys
from functools import partial

from shared.lifecycle import configure_logging, run_service
from shared.sole_robot import TakenError
from simulator.service import run
from simulator.service_settings import SimulatorSettings
from simulator.world.world_check import start_faults
from simulator.world.world_file import WorldFileError, load_world


def main() -> None:
    """Run the simulator until a signal; a bad world file or a taken name ends it with one line."""
    settings = SimulatorSettings.of_service("simulator")
    configure_logging("simulator", settings.log_level)  # a large world takes long, and says how far it is
    try:
        world = load_world(settings.world)
    except WorldFileError as error:
        sys.exit(f"simulator: {error}")
    if faults := start_faults(world):
        sys.exit(f"simulator: {settings.world}: {faults[0]}")
    try:
        run_service("simulator", settings, partial(run, settings, world))
    except TakenError as error:
        sys.exit(f"simulator: {error}")


if __name__ == "__main__":
    main()
