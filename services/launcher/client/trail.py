"""The true way of a robot, kept by frame. For evaluation only: no service ever sees it. Pure."""

import math
from bisect import bisect_left
from collections.abc import Iterable
from dataclasses import dataclass, field
from itertools import pairwise

from shared.messages.simulation import Pose, Truth

JUMP_M = 0.4
TOP_SPEED_MPS = 1.5
"""No robot of ours moves further than JUMP_M + TOP_SPEED_MPS * dt between two frames: somebody moved it.
That is nearly twice what wheels of 0.08 m do at the 10 rad/s of the outdoor profiles, and a frame lost."""

MAX_GAP_S = 0.5
"""Between states of a longer gap the robot may have turned: frames come every 0.1 to 0.5 s."""


@dataclass
class Trail:
    """True states in order of arrival, each frame once."""

    truths: list[Truth] = field(default_factory=list)
    _seen: set[tuple[int, int]] = field(default_factory=set)
    _stamps_ns: list[int] = field(default_factory=list)

    def add(self, truths: Iterable[Truth]) -> None:
        """Append those of frames not seen before; lockstep repeats a frame until it is answered."""
        for truth in truths:
            if (truth.seq, truth.stamp_ns) not in self._seen:
                self._seen.add((truth.seq, truth.stamp_ns))
                self._stamps_ns.append(truth.stamp_ns)
                self.truths.append(truth)

    def begun(self, stamp_ns: int) -> bool:
        """Whether a state of that time or earlier is known."""
        return bool(self._stamps_ns) and self._stamps_ns[0] <= stamp_ns

    def mark(self) -> int:
        """How long the trail is by now, for `since`."""
        return len(self.truths)

    def since(self, mark: int) -> list[Truth]:
        """States from the last one before `mark` on."""
        return self.truths[max(0, mark - 1) :]

    def pose_at(self, stamp_ns: int) -> Pose | None:
        """True pose at a capture time: that of the frame, or between two neighbours where its own was lost.

        None where the nearest states are further than MAX_GAP_S apart.
        """
        after = bisect_left(self._stamps_ns, stamp_ns)
        if after == len(self._stamps_ns):
            return None
        if self._stamps_ns[after] == stamp_ns:
            return self.truths[after].pose
        if after == 0 or self._stamps_ns[after] - self._stamps_ns[after - 1] > MAX_GAP_S * 1e9:
            return None
        span_ns = self._stamps_ns[after] - self._stamps_ns[after - 1]
        share = (stamp_ns - self._stamps_ns[after - 1]) / span_ns
        return _between(self.truths[after - 1].pose, self.truths[after].pose, share)


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


def spl(success: bool, shortest_m: float, driven_m: float) -> float:
    """Success weighted by path length, S * l / max(p, l).

    P. Anderson et al., On Evaluation of Embodied Navigation Agents, 2018.

    Args:
        success: whether the goal was reached.
        shortest_m: length l of the shortest collision-free way, metres, positive.
        driven_m: length p of the way taken, metres.

    Raises:
        ValueError: a length that is not positive.
    """
    if not shortest_m > 0.0:
        raise ValueError(f"shortest_m must be positive, got {shortest_m}")
    return float(success) * shortest_m / max(driven_m, shortest_m)


def _apart_m(a: Pose, b: Pose) -> float:
    return math.hypot(b.x_m - a.x_m, b.y_m - a.y_m)


def _between(a: Pose, b: Pose, share: float) -> Pose:
    turn_rad = math.remainder(b.yaw_rad - a.yaw_rad, math.tau)
    return Pose(
        x_m=a.x_m + share * (b.x_m - a.x_m),
        y_m=a.y_m + share * (b.y_m - a.y_m),
        yaw_rad=math.remainder(a.yaw_rad + share * turn_rad, math.tau),
    )
