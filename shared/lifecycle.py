"""How a service starts and stops: JSON logs, signals, and the loop's life around the bus."""

import json
import logging
import signal
import socket
import sys
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager

from shared.access.credentials import CredentialsError
from shared.bus import Bus, UnreachableError, open_bus
from shared.settings import ServiceSettings

log = logging.getLogger(__name__)

STOPPING = (signal.SIGINT, signal.SIGTERM)


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
    """An event that SIGINT and SIGTERM set, whatever the main thread does. To be called in the main thread.

    A handler written in Python runs in the main thread, between two of its steps. It cannot set the event:
    that thread may be inside `stop.wait`, holding the event's lock. And it may never run: a signal that comes
    just before the thread blocks does not wake it. So the interpreter is asked to write each signal's number
    into a socket at the moment it comes, and a thread of its own reads it there.
    """
    stop = threading.Event()
    reader, writer = socket.socketpair()
    writer.setblocking(False)
    threading.Thread(target=_forward, args=(reader, writer, stop), name="signals", daemon=True).start()
    signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    for number in STOPPING:
        signal.signal(number, lambda *_: None)
    return stop


def _forward(reader: socket.socket, _writer: socket.socket, stop: threading.Event) -> None:
    """Set `stop` when a stopping signal arrives. Both ends stay open for as long as signals may come."""
    while received := reader.recv(64):
        if any(number in STOPPING for number in received):
            stop.set()


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


@contextmanager
def in_thread(work: Callable[[threading.Event], object], name: str) -> Iterator[Callable[[], None]]:
    """Do something beside the block; its event is set at the end of the block, which waits for it.

    Returns:
        What raises the work's exception, once it failed, in the thread of the block; its end does so, too.
    """
    stop = threading.Event()
    with ThreadPoolExecutor(1, name) as threads:
        beside = threads.submit(work, stop)

        def check() -> None:
            if beside.done():
                beside.result()

        try:
            yield check
        finally:
            stop.set()
    beside.result()
