"""The reader: opens anew what breaks, notices what hangs, and says why nothing comes."""

import threading
import time
from itertools import count

import numpy as np
import pytest

from services.camera import reader as reading
from services.camera.reader import Reader
from services.camera.source import CameraFacts, EndOfPicturesError, Picture, SourceError
from shared.bus import wait_until
from shared.jpeg import BadPictureError

SOON_S = 20.0


class Script:
    """Sources that do what stands in a list, each item once: a picture's number, or what is raised."""

    def __init__(self, *turns):
        self.turns, self.opened, self.closed, self.closed_all = list(turns), 0, 0, threading.Event()

    def open(self):
        self.opened += 1
        return self

    facts = CameraFacts("model", "image", 0.5)

    def read(self):
        if not self.turns:
            self.closed_all.wait(0.01)
            raise EndOfPicturesError("no further picture")
        turn = self.turns.pop(0)
        if isinstance(turn, Exception):
            raise turn
        return Picture(np.full((2, 4, 3), turn, np.uint8), time.time_ns())

    def close(self):
        self.closed += 1


@pytest.fixture(autouse=True)
def _short_pauses(monkeypatch):
    monkeypatch.setattr(reading, "FIRST_PAUSE_S", 0.001)
    monkeypatch.setattr(reading, "LAST_PAUSE_S", 0.001)


@pytest.fixture
def start():
    stop, readers, bad = threading.Event(), [], []

    def started(script, **how):
        reader = Reader(script.open, "camera", stop, threading.Event(), bad.append, **how)
        readers.append(reader)
        reader.start()
        return reader, bad

    yield started
    stop.set()
    for one in readers:
        one.join(SOON_S)


def taken_all(reader):
    """Values of all pictures until the end."""
    values = []

    def over():
        picture = reader.take()
        if picture is not None:
            values.append(int(picture.data[0, 0, 0]))
        return reader.status().finished and picture is None

    assert wait_until(over, SOON_S)
    return values


def test_a_source_that_breaks_is_closed_and_opened_anew(start):
    script = Script(1, SourceError("the plug slipped"), 2, SourceError("again"), 3)
    reader, _ = start(script, lossless=True)
    assert taken_all(reader) == [1, 2, 3]
    assert (script.opened, script.closed) == (3, 3)


def test_a_bad_picture_is_told_and_skipped(start):
    reader, bad = start(Script(1, BadPictureError("damaged"), 2), lossless=True)
    assert taken_all(reader) == [1, 2]
    assert bad == ["damaged"]


def test_a_source_of_nothing_but_bad_pictures_is_opened_anew(start):
    script = Script(*[BadPictureError("damaged")] * reading.MOST_BAD, 1)
    reader, _ = start(script, lossless=True)
    assert taken_all(reader) == [1]
    assert script.opened == 2


class Endless(Script):
    def __init__(self, values):
        super().__init__()
        self._values = values

    def read(self):
        self.closed_all.wait(0.001)
        return Picture(np.full((2, 4, 3), next(self._values), np.uint8), time.time_ns())


def test_a_live_camera_that_repeats_itself_is_frozen(start, monkeypatch):
    monkeypatch.setattr(reading, "FROZEN_S", 0.05)
    monkeypatch.setattr(reading, "LAST_PAUSE_S", 0.5)
    script = Endless(iter(lambda: 7, None))
    reader, _ = start(script)
    assert wait_until(lambda: "frozen: the same picture" in reader.status().problem, SOON_S)
    assert wait_until(lambda: script.opened > 1, SOON_S)


def test_a_folder_may_repeat_itself(start):
    reader, _ = start(Script(7, 7, 7), live=False, lossless=True)
    assert taken_all(reader) == [7, 7, 7]


def test_the_newest_picture_waits_and_the_rate_is_measured(start):
    reader, _ = start(Endless(n % 256 for n in count()))
    assert wait_until(lambda: reader.status().rate_hz > 20.0, SOON_S)
    assert reader.status().facts.battery_fraction == 0.5
    assert reader.status().problem == ""


def test_a_mistake_in_the_program_is_no_silence(start, recwarn):
    script = Script(ZeroDivisionError("a mistake"))
    reader, _ = start(script)

    def died():
        try:
            reader.take()
        except RuntimeError:
            return True
        return False

    assert wait_until(died, SOON_S)
    recwarn.clear()
