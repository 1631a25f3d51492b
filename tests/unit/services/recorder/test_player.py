"""A replay keeps the pauses of the recording, divided by the rate."""

import threading

import pytest

from services.recorder.backlog import Sample
from services.recorder.player import play


class Time:
    """A clock that goes on only while somebody waits."""

    def __init__(self):
        self.now_s = 0.0

    def __call__(self):
        return self.now_s

    def wait(self, seconds):
        self.now_s += seconds


def sample(at_s):
    return Sample("topnav/r1/ranges", b"", int(at_s * 1e9))


@pytest.mark.parametrize("rate", [0.5, 1.0, 4.0])
def test_messages_come_when_they_are_due(rate):
    time, sent = Time(), []
    recorded = [sample(t) for t in (100.0, 100.5, 100.5, 103.0)]
    play(recorded, lambda _: sent.append(time.now_s), rate, threading.Event(), time, time.wait)
    assert sent == pytest.approx([0.0, 0.5 / rate, 0.5 / rate, 3.0 / rate])


def test_a_slow_publisher_is_caught_up_with():
    time, sent = Time(), []

    def put(_):
        sent.append(time.now_s)
        time.wait(1.0 if len(sent) == 1 else 0.0)

    play([sample(t) for t in (0.0, 0.2, 0.4, 2.0)], put, 1.0, threading.Event(), time, time.wait)
    assert sent == pytest.approx([0.0, 1.0, 1.0, 2.0])


def test_stop_ends_it_between_two_messages():
    time, sent, stop = Time(), [], threading.Event()

    def put(one):
        sent.append(one)
        stop.set()

    play([sample(0.0), sample(1.0)], put, 1.0, stop, time, time.wait)
    assert len(sent) == 1
