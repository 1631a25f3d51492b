"""Inboxes: newest only or a queue, malformed payloads counted, warnings at a limited rate."""

import logging
import threading
from types import SimpleNamespace

import pytest

from shared.inbox import Counters, Inbox
from shared.messages.drive import Velocity
from shared.wire import encode


def inbox(capacity: int, counters: Counters | None = None) -> Inbox[Velocity]:
    return Inbox(Velocity, 10_000, capacity, threading.Event(), counters or Counters())


def push(box: Inbox[Velocity], *numbers: int) -> None:
    for number in numbers:
        box.push(encode(Velocity(robot="r1", seq=number)))


def test_an_inbox_of_one_keeps_the_newest():
    box = inbox(1)
    push(box, 1, 2, 3)
    assert [message.seq for message in box.take_all()] == [3]
    assert box.take() is None


def test_a_queue_keeps_the_order_and_counts_what_it_loses():
    counters = Counters()
    box = inbox(3, counters)
    push(box, 1, 2, 3, 4, 5)
    assert [message.seq for message in box.take_all()] == [3, 4, 5]
    assert counters.snapshot() == {"overflow": 2}


def test_losing_old_frames_on_purpose_is_no_overflow():
    counters = Counters()
    push(inbox(1, counters), 1, 2, 3)
    assert counters.snapshot() == {}


def test_malformed_payloads_are_counted_and_skipped():
    counters = Counters()
    box = inbox(8, counters)
    for junk in (b"", b"\xc1", b"\x91" * 5_000, encode(Velocity(robot="r1"))[:-1], bytes(10_001)):
        box.push(junk)
    push(box, 7)
    assert [message.seq for message in box.take_all()] == [7]
    assert counters.snapshot() == {"malformed": 5}


def test_waiting_gives_the_message_or_none():
    box = inbox(1)
    assert box.wait(0.0) is None
    threading.Timer(0.05, push, (box, 4)).start()
    message = box.wait(30.0)
    assert message is not None
    assert message.seq == 4


def test_a_flood_of_junk_is_logged_once_a_second(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
):
    clock = SimpleNamespace(now_s=0.0)
    monkeypatch.setattr("shared.inbox.time", SimpleNamespace(monotonic=lambda: clock.now_s))
    counters = Counters()
    with caplog.at_level(logging.WARNING):
        for second in (7.0, 7.9, 8.1, 8.9):
            clock.now_s = second
            for _ in range(250):
                counters.count("malformed", "junk")
    assert counters.snapshot() == {"malformed": 1_000}
    assert [record.getMessage() for record in caplog.records].count("malformed: junk") == 2


def test_payloads_that_are_too_long_are_not_kept_and_all_together_are_bounded(
    monkeypatch: pytest.MonkeyPatch,
):
    monkeypatch.setattr("shared.inbox.QUEUE_BYTES", 1_000)
    counters = Counters()
    box = Inbox(Velocity, 400, 1024, threading.Event(), counters)
    box.push(bytes(401))
    assert counters.snapshot() == {"malformed": 1}
    for _ in range(10):
        box.push(bytes(300))
    assert box._waiting_bytes <= 1_000
    assert counters.snapshot()["overflow"] == 7
    assert box.take_all() == []
    assert box._waiting_bytes == 0
