"""The heading and distances that drive goes by: what is late, stale or was held up moves nothing. Pure.

All ages are counted on this process's own monotonic clock, in seconds: no other machine's clock has a say
(decision 0022).
"""

import logging
import math
from bisect import bisect_left
from collections.abc import Callable

from shared.messages.drive import Heading
from shared.messages.sensors import Ranges

log = logging.getLogger(__name__)

STEP_S = 0.05
"""Between two steps of the loop; chosen: twice the rate at which distances come (simulator: 10 Hz)."""
RANGES_TTL_S = 0.4
"""Distances older than this stop the wheels; chosen: four readings of the simulator's sensors."""
SUSPENDED_S = 0.5
"""A loop that missed ten of its steps stood still itself, with everything that waited for it; chosen: one ttl
of a heading, after which all of it is too old anyway."""
BACKLOG_S = 0.2
"""What piled up meanwhile, or while the network was cut, arrives within this: `pytest
tests/faults/test_cut_network.py` saw nothing old obeyed (deploy/FAULTS.md, fault 9)."""
DECIDING_S = 2.0
"""The longest that features and planner may take from a frame to its heading; chosen: twenty times the 99th
percentile of 109 ms (`topnav bench loop --real-time`)."""
MOST_FRAMES = 1_000
"""Frames remembered; chosen: half of them, the fewest there are, last 100 s at 5 frames/s, longer than any
heading may live."""
NEVER_S = -1.0e9
"""Time of what has not happened yet: long ago."""


class FrameAges:
    """Remembers when each frame number was first heard of; times are monotonic seconds."""

    def __init__(self) -> None:
        self._seqs: list[int] = []
        self._heard_s: list[float] = []

    def heard(self, seq: int, now_s: float) -> None:
        """Note that the robot is at frame `seq`; a lower number than before is a robot that restarted."""
        if self._seqs and seq < self._seqs[-1]:
            self._seqs.clear()
            self._heard_s.clear()
        if not self._seqs or seq > self._seqs[-1]:
            self._seqs.append(seq)
            self._heard_s.append(now_s)
        if len(self._seqs) > MOST_FRAMES:
            del self._seqs[: MOST_FRAMES // 2], self._heard_s[: MOST_FRAMES // 2]

    def age_s(self, seq: int, now_s: float) -> float:
        """How long ago frame `seq` was taken, at least; 0 for one that was not heard of yet."""
        index = bisect_left(self._seqs, seq)
        return now_s - self._heard_s[index] if index < len(self._seqs) else 0.0


class Inputs:
    """Keeps the newest heading and distances that may be obeyed.

    Args:
        count: counts a refused message by kind, with a text that says why.

    Attributes:
        heading: the newest that counted; `too_old` says whether it still does.
        ranges: the newest distances; in lockstep None once they were answered.
    """

    def __init__(self, count: Callable[[str, str], None]) -> None:
        self._count = count
        self.heading: Heading | None = None
        self.ranges: Ranges | None = None
        self._heading_s = self._ranges_s = self._robot_heard_s = NEVER_S
        self._last_step_s, self._ignore_until_s = math.inf, NEVER_S
        self._last_heading: Heading | None = None  # for the order; a silent robot may come back restarted
        self._last_ranges: Ranges | None = None
        self._ages, self._lockstep = FrameAges(), False

    def take(self, ranges: Ranges | None, heading: Heading | None, now_s: float) -> bool:
        """Take what came since the last step; whether there was news.

        What waited while this process was suspended, or cut off from the robot, may be as old as that, and
        looks fresh when it is read: it is thrown away. What is read now may have come just after the last
        step, so its age is counted from then.
        """
        since_s = min(self._last_step_s, now_s)
        if now_s - since_s > SUSPENDED_S:
            log.warning("suspended for %.1f s: what came meanwhile is thrown away", now_s - since_s)
            self._ignore_backlog(now_s)
        elif since_s < self._ignore_until_s:  # a backlog waits for as long as this process was held up
            self._ignore_until_s += max(0.0, now_s - since_s - STEP_S)
        self._last_step_s = now_s
        if ranges is not None:
            self._hear_robot(ranges, now_s)
        if now_s < self._ignore_until_s:
            return False
        fresh = ranges is not None and self._take_ranges(ranges, now_s, since_s)
        if heading is None or not self._counts(heading, now_s):
            return fresh
        self.heading = self._last_heading = heading
        self._heading_s = since_s
        return True

    def expire_heading(self) -> None:
        """Let the heading count as too old: who made it is gone."""
        self._heading_s = NEVER_S

    @property
    def newest_ranges(self) -> Ranges | None:
        """The newest distances, answered or not."""
        return self._last_ranges

    def answered(self) -> None:
        """The robot was told what to do: in lockstep it says its distances anew."""
        if self._lockstep:
            self.ranges = None

    def too_old(self, now_s: float) -> bool:
        """Whether heading or distances have outlived their time."""
        assert self.heading is not None
        return now_s - self._heading_s > self.heading.ttl_ms / 1000.0 or self.are_ranges_too_old(now_s)

    def are_ranges_too_old(self, now_s: float) -> bool:
        """Whether the distances have outlived their time; in lockstep time stands still."""
        return not self._lockstep and now_s - self._ranges_s > RANGES_TTL_S

    def _hear_robot(self, ranges: Ranges, now_s: float) -> None:
        """Note that the robot is there; after a silence what comes first may have been sent long ago."""
        silent_s = now_s - self._robot_heard_s
        if not ranges.lockstep and self.ranges is not None and silent_s > RANGES_TTL_S:
            self._count("silence", f"nothing from the robot for {silent_s:.1f} s")
            self._ignore_backlog(now_s)
            self._last_heading = self._last_ranges = None
        self._robot_heard_s = now_s

    def _ignore_backlog(self, now_s: float) -> None:
        self._heading_s, self._ignore_until_s = NEVER_S, now_s + BACKLOG_S

    def _take_ranges(self, ranges: Ranges, now_s: float, since_s: float) -> bool:
        last = self._last_ranges
        if last is not None and not ranges.lockstep and _is_behind(ranges, last):
            self._count("late", f"distances of frame {ranges.seq} after those of {last.seq}")
            return False
        self.ranges = self._last_ranges = ranges
        self._ranges_s, self._lockstep = since_s, ranges.lockstep
        self._ages.heard(ranges.seq, now_s)
        return True

    def _counts(self, heading: Heading, now_s: float) -> bool:
        """Refuse headings of a planner that was replaced, that were overtaken, or held up on their way."""
        newest, last = self.heading, self._last_heading
        if newest is not None and heading.epoch < newest.epoch:
            self._count("old_epoch", f"heading of epoch {heading.epoch}, newest is {newest.epoch}")
            return False
        if self._lockstep:
            return True
        if last is not None and _is_overtaken(heading, last):
            self._count("late", f"heading of frame {heading.seq} after that of {last.seq}")
            return False
        age_s = self._ages.age_s(heading.seq, now_s)
        if age_s > DECIDING_S + heading.ttl_ms / 1000.0:
            self._count("stale", f"heading of frame {heading.seq}, which is {age_s:.1f} s old")
            return False
        return True


def _is_behind(message: Heading | Ranges, newest: Heading | Ranges) -> bool:
    """Whether a message is older than `newest`, by number and by time: a restarted robot counts anew."""
    return message.seq < newest.seq and message.stamp_ns < newest.stamp_ns


def _is_overtaken(heading: Heading, last: Heading) -> bool:
    """Whether a planner's newer answer came before this one. One said twice does not live longer for that."""
    if heading.epoch != last.epoch:
        return False
    again = (heading.seq, heading.stamp_ns, heading.mission_id) == (last.seq, last.stamp_ns, last.mission_id)
    return again or _is_behind(heading, last)
