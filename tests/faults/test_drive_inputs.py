"""What the drive process is told goes missing, comes twice, late, in the wrong order, or is no number."""

import math
import time
from itertools import count

import msgpack
import pytest

from shared.messages import Heading, Ranges
from shared.topics import HEADING, RANGES
from shared.wire import encode

STOP_S = 0.5
POLL_S = 0.1
"""Commands are collected in steps of 30 ms on a machine that may be busy."""
READ_S = 0.06
"""Drive reads the newest only: what is to be overtaken has to be read before."""
LEFT, RIGHT = 0.5, -0.5


class Stream:
    """A robot and its planner, frame by frame."""

    def __init__(self, neighbours):
        self._neighbours, self._seqs = neighbours, count(10)
        self.seq = 0

    def see(self):
        self.seq = next(self._seqs)
        self._neighbours.see(self.seq)

    def both_at(self, shift_ns):
        """The robot's clock is wrong by `shift_ns`."""
        self.seq, stamp_ns = next(self._seqs), time.time_ns() + shift_ns
        self._neighbours.see(self.seq, stamp_ns=stamp_ns)
        self._neighbours.wish(self.seq, stamp_ns=stamp_ns, heading_rad=LEFT)

    def both(self):
        self.see()
        self._neighbours.wish(self.seq, heading_rad=LEFT)


@pytest.fixture
def stream(start_drive, neighbours):
    start_drive()
    stream = Stream(neighbours)
    assert neighbours.drives(stream.both)
    return stream


def moving_until_s(neighbours, act, during_s=1.2):
    """How long after now a command with turning wheels still came."""
    began_s, last_s = time.monotonic(), 0.0
    while (now_s := time.monotonic() - began_s) < during_s:
        if any(command.wheel_speed_radps for command in neighbours.commands(0.03, act)):
            last_s = now_s
    return last_s


def test_without_headings_the_wheels_stop(stream, neighbours, record_property):
    ended_s = moving_until_s(neighbours, stream.see)
    record_property("last_moving_command_s", round(ended_s, 3))
    assert ended_s <= STOP_S + POLL_S


def test_without_distances_the_wheels_stop(stream, neighbours, record_property):
    ended_s = moving_until_s(neighbours, lambda: neighbours.wish(stream.seq, heading_rad=LEFT))
    record_property("last_moving_command_s", round(ended_s, 3))
    assert ended_s <= STOP_S + POLL_S


def test_a_heading_said_twice_does_not_live_longer(stream, neighbours):
    stamp_ns = time.time_ns()

    def repeat():
        neighbours.see(stream.seq)
        neighbours.wish(stream.seq, stamp_ns=stamp_ns, heading_rad=LEFT)

    assert moving_until_s(neighbours, repeat, 1.5) <= 0.5 + STOP_S  # the ttl of these headings is 0.5 s


def test_headings_in_the_wrong_order_are_refused(stream, neighbours):
    def shuffled():
        stream.both()
        time.sleep(READ_S)
        neighbours.wish(stream.seq - 2, heading_rad=RIGHT, age_s=0.2)

    commands = neighbours.commands(1.0, shuffled)
    assert any(command.steer_rad > 0.0 for command in commands)
    assert not any(command.steer_rad < 0.0 for command in commands)


def test_distances_in_the_wrong_order_are_refused(stream, neighbours):
    def shuffled():
        stream.both()
        time.sleep(READ_S)
        neighbours.see(stream.seq - 3, stamp_ns=time.time_ns() - 10**9, near_m=0.05)  # a wall all around

    commands = neighbours.commands(1.0, shuffled)
    assert commands
    assert all(command.wheel_speed_radps for command in commands)


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

    commands = neighbours.commands(1.2, poison)
    assert all(math.isfinite(c.steer_rad) and math.isfinite(c.wheel_speed_radps) for c in commands)
    assert not any(command.steer_rad < 0.0 for command in commands)
    assert not any(command.wheel_speed_radps for command in neighbours.commands(0.3, poison)), "none is fresh"
    assert neighbours.drives(stream.both), "it lives and goes on"


def test_a_clock_that_jumps_an_hour_stops_nothing_and_outdates_nothing(stream, neighbours):
    for hours in (0, 1, -1, 0):
        commands = neighbours.commands(0.8, lambda: stream.both_at(int(hours * 3600e9)))  # noqa: B023
        assert commands
        assert all(command.wheel_speed_radps for command in commands), f"the clock moved by {hours} h"
