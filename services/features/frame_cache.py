"""The newest frames with their features, and what to do with one that comes: new, again or stale. Pure."""

import zlib
from collections import OrderedDict
from dataclasses import dataclass
from typing import Literal

from shared.messages.features import Features
from shared.messages.sensors import Frame

RESTARTED_FRAMES = 10
"""So many frames one after the other that are all behind: a camera that restarted with its clock set back;
chosen: two seconds of frames at 5 Hz, more than a network delays in order."""


@dataclass(frozen=True)
class FrameKey:
    """What makes two frames the same picture."""

    seq: int
    stamp_ns: int
    checksum: int

    @classmethod
    def of(cls, frame: Frame) -> "FrameKey":
        """Key of a frame; the checksum tells a restarted simulator's frame 0 from the one before."""
        return cls(frame.seq, frame.stamp_ns, zlib.crc32(frame.data))


class FrameCache:
    """The newest frames and their features, by frame number."""

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._kept: OrderedDict[int, tuple[FrameKey, Features, Frame]] = OrderedDict()
        self._last: FrameKey | None = None
        self._late: FrameKey | None = None
        self._climbed = 0

    def judge(self, key: FrameKey, lockstep: bool) -> Literal["new", "again", "stale"]:
        """Say whether to extract this frame, publish its features again, or ignore it.

        A lower number is a restarted camera when its clock has moved on; without lockstep it is otherwise a
        late frame, also where it came in time before. In lockstep one frame is under way at a time, so none
        is ever late.
        """
        if self.same(key) is not None:
            return "again" if lockstep or key == self._last else "stale"
        if self._last is None or lockstep:
            return "new"
        behind = key.seq <= self._last.seq and key.stamp_ns <= self._last.stamp_ns
        return "stale" if behind and not self._counts_anew(key) else "new"

    def _counts_anew(self, late: FrameKey) -> bool:
        """Whether late frames come in an order of their own, for so long that they are the camera's now."""
        climbs = self._late is not None and late.seq > self._late.seq
        self._climbed, self._late = self._climbed + 1 if climbs else 0, late
        return self._climbed >= RESTARTED_FRAMES

    def put(self, key: FrameKey, features: Features, frame: Frame) -> None:
        """Keep the newest; frames of before a restart are forgotten, their numbers mean other pictures."""
        if self._last is not None and key.seq <= self._last.seq:
            self._kept.clear()
        self._kept[key.seq] = (key, features, frame)
        self._last, self._late, self._climbed = key, None, 0
        while len(self._kept) > self._capacity:
            self._kept.popitem(last=False)

    def same(self, key: FrameKey) -> Features | None:
        """Features of exactly this picture, if kept."""
        kept = self._kept.get(key.seq)
        return kept[1] if kept is not None and kept[0] == key else None

    def get(self, seq: int) -> Features | None:
        """Features of the frame with this number, if kept."""
        kept = self._kept.get(seq)
        return kept[1] if kept is not None else None

    def frame(self, seq: int) -> Frame | None:
        """The frame with this number, if kept."""
        kept = self._kept.get(seq)
        return kept[2] if kept is not None else None

    def is_ahead(self, seq: int) -> bool:
        """Whether the frame with this number would be newer than all that came."""
        return self._last is None or seq > self._last.seq

    def span(self) -> str:
        """Numbers kept, for an error text."""
        return f"{next(iter(self._kept))} to {next(reversed(self._kept))}" if self._kept else "none"
