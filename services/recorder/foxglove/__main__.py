"""Entry point: `python -m services.recorder.foxglove`, what the bus says, live in Foxglove."""

import logging
import sys
import threading

from services.recorder.channels import RecordingError
from services.recorder.foxglove.live.service import serve
from services.recorder.foxglove.live.settings import LiveSettings
from shared.bus import Bus
from shared.lifecycle import run_service

log = logging.getLogger(__name__)


def main() -> None:
    """Serve until a signal."""
    settings = LiveSettings.of_service("foxglove")

    def loop(bus: Bus, stop: threading.Event) -> None:
        try:
            serve(bus, settings, stop)
        except RecordingError as error:
            log.error("%s", error)
            sys.exit(1)

    run_service("foxglove", settings, loop)


if __name__ == "__main__":
    main()
