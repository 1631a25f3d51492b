"""Frames between exposure and the robot's computer: each arrives late, some never. Pure.

A real camera delivers 100 to 400 ms after the exposure (a panorama stitched and sent by wifi), and loses
frames. Times are nanoseconds of the clock that the caller stamps frames by.
"""

from collections import deque
from typing import Generic, TypeVar

from simulator.disturbances.levels import generator

MOST_S = 0.6
"""Delay at level 1; chosen: half as much again as the slowest of the usual 360-degree cameras."""
MOST_LOST = 0.5
"""Share of frames that are lost at level 1; chosen: a wifi at the edge of its reach."""

T = TypeVar("T")


class Transit(Generic[T]):
    """Frames on their way.

    Args:
        latency: level of the delay, 0 to 1.
        drops: level of the losses, 0 to 1.
        seed: of the losses.
    """

    def __init__(self, latency: float, drops: float, seed: int) -> None:
        self.delay_ns = round(100.0 * latency * MOST_S) * 10_000_000  # whole steps of the physics
        self._lost, self._seed = drops * MOST_LOST, seed
        self._under_way: deque[tuple[int, T]] = deque()

    def loses(self, seq: int) -> bool:
        """Whether the frame of this number is one of those that never arrive."""
        return self._lost > 0.0 and float(generator(self._seed, "drops", seq).random()) < self._lost

    def expose(self, frame: T, now_ns: int) -> None:
        """A frame sets out."""
        self._under_way.append((now_ns, frame))

    def clear(self) -> None:
        """What is under way shows what is no more."""
        self._under_way.clear()

    def arrived(self, now_ns: int) -> list[T]:
        """What has arrived since the last call, oldest first."""
        there = []
        while self._under_way and self._under_way[0][0] + self.delay_ns <= now_ns:
            there.append(self._under_way.popleft()[1])
        return there
