"""What the drive process is told goes missing, comes twice, late, in the wrong order, or is no number."""

import math
import time
from functools import partial
from itertools import count, pairwise

import msgpack
import pytest

from shared.bus import wait_until
from shared.messages.drive import Heading
from shared.messages.sensors import Ranges
from shared.topics import HEADING, RANGES
from shared.wire import encode

pytestmark = [pytest.mark.usefixtures("patient_sessions")]

STOP_S = 0.5
POLL_S = 0.1
"""Commands are collected in steps of 30 ms on a machine that may be busy."""
HELD_UP_S = 0.25
"""A step that takes longer says more about this process than about drive."""
TRIES = 8
"""Where drive or this process is held up, a stop is seen later than it is, and drive forgets in what order
things came. So the best of several counts; what is broken is so every time."""
ORDER_S, SOON_S = 1.0, 30.0
READ_S = 0.06
"""Within this drive has usually read what was sent."""
LEFT, RIGHT = 0.5, -0.5
EXPIRED = "inputs too old"


class Stream:
    """A robot and its planner, frame by frame."""

    def __init__(self, neighbours):
        self._neighbours, self._seqs = neighbours, count(10)
        self.seq = self.stamp_ns = 0

    def see(self):
        self._next()
        self._neighbours.see(self.seq, stamp_ns=self.stamp_ns)

    def both(self):
        self.see()
        self._neighbours.wish(self.seq, stamp_ns=self.stamp_ns, heading_rad=LEFT)

    def both_at(self, shift_ns):
        """The robot's clock is wrong by `shift_ns`."""
        self._next(shift_ns)
        self._neighbours.see(self.seq, stamp_ns=self.stamp_ns)
        self._neighbours.wish(self.seq, stamp_ns=self.stamp_ns, heading_rad=LEFT)

    def read(self):
        """Send both until drive answers: then it has read them, and nothing newer. All commands that came."""
        came = []

        def answered():
            self.both()
            came.extend(self._neighbours.commands(READ_S))
            return any(command.seq == self.seq for command in came)

        assert wait_until(answered, SOON_S)
        return came

    def _next(self, shift_ns=0):
        self.seq, self.stamp_ns = next(self._seqs), time.time_ns() + shift_ns


@pytest.fixture
def stream(start_drive, neighbours):
    start_drive()
    stream = Stream(neighbours)
    assert neighbours.drives(stream.both)
    return stream


def moving_until_s(neighbours, act, during_s):
    """How long after now a command with turning wheels still came; infinite when this process was held up."""
    began_s, last_s = time.monotonic(), 0.0
    while (now_s := time.monotonic() - began_s) < during_s:
        if any(command.speed_mps for command in neighbours.commands(0.03, act)):
            last_s = now_s
        if time.monotonic() - began_s - now_s > HELD_UP_S:
            return math.inf
    return last_s


def soonest_s(neighbours, stream, act, most_s, during_s=1.2):
    """The shortest time for which the wheels still turned of several, unless one is within `most_s`."""
    found_s = math.inf
    for _ in range(TRIES):
        assert neighbours.drives(stream.both)
        found_s = min(found_s, moving_until_s(neighbours, act, during_s))
        if found_s <= most_s:
            break
    return found_s


def in_order(neighbours, stream, late):
    """Commands while each frame that drive has read is followed by a late one; none of them of a silence."""
    for _ in range(TRIES):
        until_s, commands = time.monotonic() + ORDER_S, []
        while time.monotonic() < until_s or not commands:
            commands += stream.read()
            late()
            commands += neighbours.commands(READ_S)
        if not any(command.why == EXPIRED for command in commands):
            break
    return commands


def test_without_headings_the_wheels_stop(stream, neighbours, record_property):
    ended_s = soonest_s(neighbours, stream, stream.see, STOP_S + POLL_S)
    record_property("last_moving_command_s", round(ended_s, 3))
    assert ended_s <= STOP_S + POLL_S


def test_without_distances_the_wheels_stop(stream, neighbours, record_property):
    def wish():
        neighbours.wish(stream.seq, heading_rad=LEFT)

    ended_s = soonest_s(neighbours, stream, wish, STOP_S + POLL_S)
    record_property("last_moving_command_s", round(ended_s, 3))
    assert ended_s <= STOP_S + POLL_S


def test_a_heading_said_twice_does_not_live_longer(stream, neighbours):
    def repeat():
        neighbours.see(stream.seq)
        neighbours.wish(stream.seq, stamp_ns=stream.stamp_ns, heading_rad=LEFT)

    most_s = 0.5 + STOP_S  # the ttl of these headings is 0.5 s
    assert soonest_s(neighbours, stream, repeat, most_s, 1.5) <= most_s


def test_headings_in_the_wrong_order_are_refused(stream, neighbours):
    def late():
        stamp_ns = stream.stamp_ns - 2 * 10**8
        neighbours.wish(stream.seq - 2, stamp_ns=stamp_ns, heading_rad=RIGHT)

    commands = in_order(neighbours, stream, late)
    assert any(command.left_mps > 0.0 for command in commands)
    assert not any(command.left_mps < 0.0 for command in commands)


def test_distances_in_the_wrong_order_are_refused(stream, neighbours):
    def late():
        neighbours.see(stream.seq - 3, stamp_ns=stream.stamp_ns - 10**10, near_m=0.05)  # a wall all around

    commands = in_order(neighbours, stream, late)
    assert all(command.speed_mps for command in commands)


def poisoned(message, field, value):
    content = msgpack.unpackb(encode(message))
    old = content[field]
    content[field] = [value, *old[1:]] if isinstance(old, list) else value
    return msgpack.packb(content)


ANGLES = tuple(k * 0.5 for k in range(12))
POISON = [(HEADING, "heading_rad"), (HEADING, "speed_fraction")]
POISON += [(RANGES, "distances_m"), (RANGES, "angles_rad"), (RANGES, "max_range_m")]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf], ids=str)
def test_what_is_no_number_never_becomes_a_command(stream, neighbours, value):
    raw = {topic: neighbours.bus.publisher(topic, robot="r1") for topic in (HEADING, RANGES)}

    def poison():
        stream.see()
        now = {"robot": "r1", "seq": stream.seq, "stamp_ns": time.time_ns()}
        heading = Heading(epoch=1, heading_rad=RIGHT, **now)
        ranges = Ranges(angles_rad=ANGLES, distances_m=(4.0,) * 12, max_range_m=4.0, **now)
        for topic, field in POISON:
            raw[topic].put_bytes(poisoned(heading if topic is HEADING else ranges, field, value))

    def stands():
        return not any(command.speed_mps for command in neighbours.commands(0.3, poison))

    commands = neighbours.commands(1.2, poison)
    assert all(math.isfinite(c.left_mps) and math.isfinite(c.forward_mps) for c in commands)
    assert not any(command.left_mps < 0.0 for command in commands)
    assert wait_until(stands, SOON_S), "none is fresh"
    assert neighbours.drives(stream.both), "it lives and goes on"


def wrong_after_a_jump(neighbours, stream, before_h, after_h):
    """What drive did but drive on when the robot's clock jumped from one shift to another, in hours."""
    assert neighbours.drives(partial(stream.both_at, int(before_h * 3600e9)))
    commands = neighbours.commands(0.8, partial(stream.both_at, int(after_h * 3600e9)))
    return [command.why for command in commands if not command.speed_mps] if commands else ["silent"]


def test_a_clock_that_jumps_an_hour_stops_nothing_and_outdates_nothing(stream, neighbours):
    for before_h, after_h in pairwise((0, 0, 1, -1, 0)):
        for _ in range(TRIES):
            wrong = wrong_after_a_jump(neighbours, stream, before_h, after_h)
            if not wrong:
                break
        assert wrong == [], f"the clock jumped from {before_h} to {after_h} h"
