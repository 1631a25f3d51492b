"""Entry point: `python -m services.recorder`."""

import threading

from services.recorder.channels import topics_named
from services.recorder.recorder import record
from services.recorder.recording import RecordingWriter
from services.recorder.settings import RecorderSettings
from shared.bus import Bus
from shared.lifecycle import run_service


def main() -> None:
    """Record until a signal."""
    settings = RecorderSettings.of_service("recorder")

    def loop(bus: Bus, stop: threading.Event) -> None:
        with RecordingWriter(settings.file) as writer:
            record(bus, writer, topics_named(settings.without), stop, None)

    run_service("recorder", settings, loop)


if __name__ == "__main__":
    main()
