"""Looks at a camera for some seconds: when pictures come, and some of them."""

import threading
import time
import zlib
from collections import Counter
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, field

import cv2
import numpy as np

from services.camera.checking.flashing import Change, FloatArray, next_change_s
from services.camera.frames import decoded_picture
from services.camera.settings import CameraSettings
from services.camera.source import CameraFacts, EndOfPicturesError, Picture, Source, SourceError
from shared.jpeg import BadPictureError

KEPT = 8
"""Pictures that are looked at; chosen: what is always black shows, and a raw picture has 5 MB."""
PARTS_PX = (64, 32)
"""Parts of a picture in which a screen is looked for; chosen: 6 degrees, a screen two metres away."""
MOST_BAD = 100
"""Pictures that cannot be used, after which nothing else is waited for; chosen."""

Paint = Callable[[bool], None]
"""Turns the screen bright or dark."""


@dataclass
class Watched:
    """What was seen.

    Attributes:
        arrivals_s: when pictures came that differ from the one before, monotonic; of files all.
        clock_s: what the wall clock was ahead of the monotonic one by, for each of them.
        parts: brightness of the parts (P,) of each of them, where the screen changes.
        kept: some of them, spread over the time.
        repeated: pictures that were the one before, bit by bit.
        bad: why pictures cannot be used, and how many.
        ended: why it ended early; "" where it did not.
        finished: a file had no further picture.
    """

    arrivals_s: list[float] = field(default_factory=list)
    clock_s: list[float] = field(default_factory=list)
    parts: list[FloatArray] = field(default_factory=list)
    kept: list[Picture] = field(default_factory=list)
    repeated: int = 0
    bad: Counter[str] = field(default_factory=Counter)
    changes: list[Change] = field(default_factory=list)
    facts: CameraFacts = field(default_factory=CameraFacts)
    ended: str = ""
    finished: bool = False


def watch(settings: CameraSettings, seconds: float, paint: Paint | None, rng: np.random.Generator) -> Watched:
    """Read pictures for so long after the first one.

    Args:
        settings: of the camera service.
        seconds: how long.
        paint: the screen to change meanwhile, if the delay is to be measured.
        rng: draws when it changes.
    """
    watched, stop = Watched(), threading.Event()
    painter = None
    if paint is not None:
        painter = threading.Thread(target=_change, args=(paint, rng, watched.changes, stop), daemon=True)
    try:
        with closing(settings.camera.opener(stop)()) as source:
            if painter is not None:
                painter.start()
            _read(source, settings.camera.kind.live, seconds, watched, with_parts=paint is not None)
    except EndOfPicturesError as error:
        watched.finished, watched.ended = True, str(error)
    except SourceError as error:
        watched.ended = str(error)
    finally:
        stop.set()
        if painter is not None and painter.ident is not None:
            painter.join()
    return watched


def _read(source: Source, live: bool, seconds: float, watched: Watched, *, with_parts: bool) -> None:
    until_s, kept_s, checksum = float("inf"), float("-inf"), -1
    while time.monotonic() < until_s:
        try:
            picture = source.read()
            parts = _parts_of(picture) if with_parts else None
        except BadPictureError as error:
            watched.bad[str(error)] += 1
            if watched.bad.total() >= MOST_BAD and not watched.arrivals_s:
                return
            continue
        now_s, watched.facts = time.monotonic(), source.facts
        until_s = min(until_s, now_s + seconds)
        last, checksum = checksum, _checksum(picture)
        if live and checksum == last:
            watched.repeated += 1
            continue
        watched.arrivals_s.append(now_s)
        watched.clock_s.append(1e-9 * time.time_ns() - time.monotonic())
        if parts is not None:
            watched.parts.append(parts)
        if now_s - kept_s >= seconds / KEPT:
            kept_s = now_s
            watched.kept = [*watched.kept[-KEPT + 1 :], picture]


def _change(paint: Paint, rng: np.random.Generator, changes: list[Change], stop: threading.Event) -> None:
    bright = False
    while not stop.wait(next_change_s(rng)):
        bright = not bright
        paint(bright)
        changes.append(Change(time.monotonic(), bright))


def _parts_of(picture: Picture) -> FloatArray:
    grey = cv2.cvtColor(decoded_picture(picture, PARTS_PX[0]), cv2.COLOR_BGR2GRAY)
    small = cv2.resize(grey, PARTS_PX, interpolation=cv2.INTER_AREA)
    return np.asarray(small, dtype=np.float64).ravel()


def _checksum(picture: Picture) -> int:
    return zlib.crc32(picture.data if isinstance(picture.data, bytes) else picture.data.data)
