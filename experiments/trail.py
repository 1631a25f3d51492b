"""The true way of a robot, kept by frame. For evaluation only: no service ever sees it. Pure."""

import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise

from shared.messages.simulation import Pose, Truth

JUMP_M = 0.4
TOP_SPEED_MPS = 1.5
"""No robot of ours moves further than JUMP_M + TOP_SPEED_MPS * dt between two frames: somebody moved it."""


@dataclass
class Trail:
    """True states in order of arrival, each frame once."""

    truths: list[Truth] = field(default_factory=list)
    _seen: set[tuple[int, int]] = field(default_factory=set)
    _pose_of: dict[int, Pose] = field(default_factory=dict)

    def add(self, truths: Iterable[Truth]) -> None:
        """Append those of frames not seen before; lockstep repeats a frame until it is answered."""
        for truth in truths:
            if (truth.seq, truth.stamp_ns) not in self._seen:
                self._seen.add((truth.seq, truth.stamp_ns))
                self._pose_of[truth.stamp_ns] = truth.pose
                self.truths.append(truth)

    def mark(self) -> int:
        """A place in the trail, for `since`."""
        return len(self.truths)

    def since(self, mark: int) -> list[Truth]:
        """States from the last one before `mark` on."""
        return self.truths[max(0, mark - 1) :]

    def pose_at(self, stamp_ns: int) -> Pose | None:
        """True pose of the frame captured at `stamp_ns`."""
        return self._pose_of.get(stamp_ns)


def driven_m(truths: list[Truth]) -> float:
    """Length of the way through these states, metres."""
    return sum(_apart_m(a.pose, b.pose) for a, b in pairwise(truths))


def collisions(truths: list[Truth]) -> int:
    """Collisions begun between the first and the last of these states; the counter may restart at 0."""
    return sum(max(0, b.collisions - a.collisions) for a, b in pairwise(truths))


def manual_moves(truths: list[Truth]) -> int:
    """How often somebody put the robot elsewhere: steps longer than it could have driven."""
    return sum(
        _apart_m(a.pose, b.pose) > JUMP_M + TOP_SPEED_MPS * max(0.0, b.sim_time_s - a.sim_time_s)
        for a, b in pairwise(truths)
    )


def _apart_m(a: Pose, b: Pose) -> float:
    return math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)
