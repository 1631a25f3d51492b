"""Entry point: `python -m services.fleet`."""

from functools import partial

from services.fleet.service import run
from services.fleet.settings import FleetSettings
from shared.lifecycle import run_service


def main() -> None:
    """Hand out the fleet's tasks until a signal."""
    settings = FleetSettings.of_service("fleet")
    run_service("fleet", settings, partial(run, settings))


if __name__ == "__main__":
    main()
