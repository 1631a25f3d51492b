"""The recorder's loop: everything the bus says goes into the file."""

import threading
import time
from collections.abc import Collection

from services.recorder.backlog import Backlog
from services.recorder.channels import name_of
from services.recorder.recording import RecordingWriter
from shared.bus import Bus
from shared.topics import TOPICS

FLUSH_PERIOD_S = 1.0  # what a killed recorder loses at most


def record(
    bus: Bus, writer: RecordingWriter, without: Collection[str], stop: threading.Event, seconds: float | None
) -> Backlog:
    """Write until `stop` is set or `seconds` are over.

    Args:
        bus: to listen to.
        writer: of the file.
        without: names of topics to leave out.
        stop: ends the recording.
        seconds: ends it, too.

    Returns:
        The backlog, which knows what was lost.
    """
    backlog = Backlog(bus.wake)
    for topic in TOPICS:
        if name_of(topic) not in without:
            bus.tap(topic, backlog.push)
    bus.announce("recorder")
    started_s = flushed_s = time.monotonic()
    while not stop.is_set():
        now_s = time.monotonic()
        if seconds is not None and now_s - started_s >= seconds:
            break
        bus.wait(0.1)
        for sample in backlog.take_all():
            writer.write(sample)
        if now_s - flushed_s >= FLUSH_PERIOD_S:
            writer.flush()
            flushed_s = now_s
    for sample in backlog.take_all():
        writer.write(sample)
    return backlog
