"""Keeps a source open in a thread of its own: what breaks is opened anew, with growing pauses."""

import logging
import threading
import time
import zlib
from collections import deque
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass

from services.camera.source import CameraFacts, EndOfPicturesError, Picture, Source, SourceError
from shared.jpeg import BadPictureError

log = logging.getLogger(__name__)

FIRST_PAUSE_S, LAST_PAUSE_S = 0.5, 4.0
"""Between two attempts, doubled each time; chosen: soon enough for a plug that slipped, and no flood."""
FROZEN_S = 2.0
"""So long the same picture, bit by bit, from a live camera: it hangs, since its noise alone never repeats."""
MOST_BAD = 20
"""Pictures in a row that cannot be used, after which the source is opened anew; chosen."""
SAID_AGAIN_S = 60.0
"""A trouble that lasts is logged once a minute; chosen."""
RATE_OVER = 20
"""Pictures over which the rate is measured; chosen: two seconds at 10 Hz."""


@dataclass(frozen=True)
class ReaderStatus:
    """How it goes.

    Attributes:
        problem: why no picture comes, empty while they do.
        rate_hz: pictures a second, over the last ones.
        finished: a file has no further picture.
    """

    problem: str
    facts: CameraFacts
    rate_hz: float
    finished: bool


class Reader:
    """Reads pictures; the newest waits until it is taken.

    Args:
        open_source: opens it, each time anew.
        name: the camera's URL for logs, without its password.
        stop: ends the thread.
        wake: set when a picture is there.
        on_bad: hears why a picture cannot be used.
        live: the same picture again means that the camera hangs.
        lossless: the next picture is read only when the last one was taken.
    """

    def __init__(
        self,
        open_source: Callable[[], Source],
        name: str,
        stop: threading.Event,
        wake: threading.Event,
        on_bad: Callable[[str], None],
        live: bool = True,
        lossless: bool = False,
    ) -> None:
        self._open, self._name, self._stop, self._wake = open_source, name, stop, wake
        self._on_bad, self._live, self._lossless = on_bad, live, lossless
        self._taken = threading.Condition()
        self._waiting: Picture | None = None
        self._problem, self._facts, self._finished = "no picture yet", CameraFacts(), False
        self._arrivals_s: deque[float] = deque(maxlen=RATE_OVER)
        self._pause_s, self._said, self._said_s = FIRST_PAUSE_S, "", 0.0
        self._sum, self._new_s = -1, 0.0
        self._thread = threading.Thread(target=self._run, name="camera", daemon=True)

    def start(self) -> None:
        """Start the thread."""
        self._thread.start()

    def join(self, timeout_s: float) -> None:
        """Wait for the thread, which ends after `stop`."""
        self._thread.join(timeout_s)

    def take(self) -> Picture | None:
        """The newest picture that was not taken yet.

        Raises:
            RuntimeError: the thread died of a mistake in this program.
        """
        if not (self._thread.is_alive() or self._finished or self._stop.is_set()):
            raise RuntimeError("the thread that reads the camera died: see the log")
        with self._taken:
            picture, self._waiting = self._waiting, None
            self._taken.notify()
        return picture

    def status(self) -> ReaderStatus:
        """How it goes now."""
        arrivals = list(self._arrivals_s)
        span_s = arrivals[-1] - arrivals[0] if len(arrivals) > 1 else 0.0
        silent = bool(self._problem)
        rate_hz = (len(arrivals) - 1) / span_s if span_s > 0.0 and not silent else 0.0
        return ReaderStatus(self._problem, self._facts, rate_hz, self._finished)

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                with closing(self._open()) as source:
                    self._read(source)
            except EndOfPicturesError as error:
                self._problem, self._finished = str(error), True
                log.info("%s: %s", self._name, error)
                return
            except SourceError as error:
                self._fail(str(error))

    def _read(self, source: Source) -> None:
        bad = 0
        while not self._stop.is_set():
            try:
                picture = source.read()
                bad = 0
            except BadPictureError as error:
                bad += 1
                self._on_bad(str(error))
                if bad >= MOST_BAD:
                    raise SourceError(f"{MOST_BAD} pictures in a row cannot be used: {error}") from error
                continue
            if source.facts != self._facts:
                self._meet(source.facts)
            if not self._live or self._is_new(picture):
                self._offer(picture)

    def _is_new(self, picture: Picture) -> bool:
        """Whether it is another picture than the last one.

        Raises:
            SourceError: it has been the same for too long.
        """
        data = picture.data if isinstance(picture.data, bytes) else picture.data.data
        checksum, now_s = zlib.crc32(data), time.monotonic()
        if checksum != self._sum:
            self._sum, self._new_s = checksum, now_s
            return True
        if now_s - self._new_s > FROZEN_S:
            self._sum = -1
            raise SourceError(f"frozen: the same picture for {FROZEN_S:.0f} s")
        return False

    def _offer(self, picture: Picture) -> None:
        if self._problem:
            log.info("%s: pictures come", self._name)
            self._arrivals_s.clear()
            self._problem, self._said, self._pause_s = "", "", FIRST_PAUSE_S
        self._arrivals_s.append(time.monotonic())
        with self._taken:
            while self._lossless and self._waiting is not None and not self._stop.is_set():
                self._taken.wait(0.2)
            self._waiting = picture
        self._wake.set()

    def _meet(self, facts: CameraFacts) -> None:
        self._facts = facts
        known = facts.battery_fraction
        battery = "" if known is None else f", battery {100.0 * known:.0f} %"
        log.info("%s: %s, mode %s%s", self._name, facts.model, facts.mode or "unknown", battery)

    def _fail(self, why: str) -> None:
        """Say it, where it is news, and pause."""
        if self._stop.is_set():
            return
        self._problem = why
        now_s = time.monotonic()
        if why != self._said or now_s - self._said_s > SAID_AGAIN_S:
            log.warning("%s: %s; trying again", self._name, why)
            self._said, self._said_s = why, now_s
        self._stop.wait(self._pause_s)
        self._pause_s = min(2.0 * self._pause_s, LAST_PAUSE_S)
