"""How a service starts and stops: JSON logs, signals, and the loop's life around the bus."""

import json
import logging
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable

from shared.bus import Bus, UnreachableError, open_bus
from shared.bus_security import CredentialsError
from shared.settings import ServiceSettings

log = logging.getLogger(__name__)


class JsonFormatter(logging.Formatter):
    """One JSON object a line, for people's tools and for the launcher."""

    def __init__(self, service: str) -> None:
        super().__init__()
        self._service = service

    def format(self, record: logging.LogRecord) -> str:
        """Return the record as one line of JSON."""
        entry: dict[str, object] = {
            "time": time.strftime("%Y-%m-%dT%H:%M:%S", time.gmtime(record.created))
            + f".{int(record.msecs):03d}Z",
            "level": record.levelname,
            "service": self._service,
            "logger": record.name,
            "text": record.getMessage(),
        }
        if record.exc_info:
            entry["error"] = self.formatException(record.exc_info)
        return json.dumps(entry)


def configure_logging(service: str, level: str) -> None:
    """Send every log record to standard error as JSON."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(JsonFormatter(service))
    logging.basicConfig(level=level, handlers=[handler], force=True)


def stop_on_signals() -> threading.Event:
    """An event that SIGINT and SIGTERM set.

    A handler runs in the middle of whatever the main thread does, and that may be `stop.wait`, which holds
    the event's lock for a moment: setting the event right there would wait for that lock for ever. So the
    handler only puts into a SimpleQueue, which may be interrupted anywhere, and a thread sets the event.
    """
    stop = threading.Event()
    asked: queue.SimpleQueue[int] = queue.SimpleQueue()

    def forward() -> None:
        asked.get()
        stop.set()

    threading.Thread(target=forward, name="signals", daemon=True).start()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda received, _frame: asked.put(received))
    return stop


def run_service(
    service: str, settings: ServiceSettings, loop: Callable[[Bus, threading.Event], None]
) -> None:
    """Run `loop(bus, stop)` with logging, signals and a bus that closes; it announces itself when ready."""
    configure_logging(service, settings.log_level)
    stop = stop_on_signals()
    try:
        with open_bus(settings.endpoint, settings.listen, settings.certs) as bus:
            log.info("started, endpoint %s, certificates %s", settings.endpoint, settings.certs)
            loop(bus, stop)
    except (CredentialsError, UnreachableError) as error:
        log.error("%s", error)
        sys.exit(1)
    log.info("stopped")
