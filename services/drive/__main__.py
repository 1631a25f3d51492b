"""Entry point: `python -m services.drive`."""

from functools import partial

from services.drive.service import run
from services.drive.settings import DriveSettings
from shared.lifecycle import run_service


def main() -> None:
    """Run the drive service until a signal."""
    settings = DriveSettings.of_service("drive")
    run_service("drive", settings, partial(run, settings))


if __name__ == "__main__":
    main()
