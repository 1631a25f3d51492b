"""New nodes of maps and the frames that they are of, brought together as they come in any order. Pure."""

from collections import deque
from dataclasses import dataclass

from shared.messages.maps import Node
from shared.messages.sensors import Frame

BESIDE_FRAMES = 3
"""How far from a node's frame, in frames, the other one may be: less than a step of the robot's length."""
WAITING_MAX = 64
"""Nodes whose frame did not come yet: those of other robots never do."""


@dataclass(frozen=True)
class NewNode:
    """A node to be read.

    Attributes:
        frame: the one that it is of.
        beside: another one, taken just before or after it.
    """

    map: str
    node_id: int
    frame: Frame
    beside: Frame


class NewNodes:
    """The newest frames of a robot, and the nodes that wait for theirs.

    Args:
        frames_kept: how many of the newest.
    """

    def __init__(self, frames_kept: int) -> None:
        self._frames: deque[Frame] = deque(maxlen=frames_kept)
        self._waiting: deque[tuple[str, Node]] = deque(maxlen=WAITING_MAX)

    def add_frame(self, frame: Frame) -> None:
        """A frame came; one that was sent again takes the place of the first."""
        if not self._frames or (self._frames[-1].seq, self._frames[-1].stamp_ns) != (
            frame.seq,
            frame.stamp_ns,
        ):
            self._frames.append(frame)

    def add_node(self, map_name: str, node: Node) -> None:
        """A node was made."""
        self._waiting.append((map_name, node))

    def take(self) -> list[NewNode]:
        """Nodes whose two frames are there; those whose frame is gone are forgotten."""
        ready, left = [], []
        for map_name, node in self._waiting:
            frame = next((one for one in self._frames if _is_of(one, node)), None)
            if frame is None:
                if not self._frames or self._frames[-1].stamp_ns < node.stamp_ns:
                    left.append((map_name, node))
            elif (beside := self._beside(frame)) is not None:
                ready.append(NewNode(map_name, node.node_id, frame, beside))
            else:
                left.append((map_name, node))
        self._waiting = deque(left, maxlen=WAITING_MAX)
        return ready

    def _beside(self, frame: Frame) -> Frame | None:
        """Rather one from before, and rather one further away: of a robot that stands all are the same."""
        near = [one for one in self._frames if 0 < abs(one.seq - frame.seq) <= BESIDE_FRAMES]
        return min(near, key=lambda one: one.seq, default=None)


def _is_of(frame: Frame, node: Node) -> bool:
    return frame.seq == node.frame_seq and frame.stamp_ns == node.stamp_ns
