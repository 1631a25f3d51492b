"""Where a simulated robot was when: for the debug view of a map, which itself knows no positions."""

from collections import OrderedDict
from collections.abc import Iterable

from shared.messages.maps import Node
from shared.messages.simulation import Truth

Position = tuple[float, float, float]
"""x and y in metres, yaw in radians, frame of the simulated world."""

FRAMES_KEPT = 50_000
"""Nearly three hours of the simulator's five frames a second, in 14 MB."""


class TruePoses:
    """The pose of each frame by its capture time; the oldest are forgotten."""

    def __init__(self, kept: int = FRAMES_KEPT) -> None:
        self._kept = kept
        self._poses: OrderedDict[int, Position] = OrderedDict()

    def take(self, truth: Truth) -> None:
        """Remember one frame's pose."""
        self._poses[truth.stamp_ns] = (truth.pose.x_m, truth.pose.y_m, truth.pose.yaw_rad)
        if len(self._poses) > self._kept:
            self._poses.popitem(last=False)

    def of_nodes(self, nodes: Iterable[Node]) -> dict[int, Position]:
        """Positions of the nodes whose frames were seen here."""
        return {node.node_id: self._poses[node.stamp_ns] for node in nodes if node.stamp_ns in self._poses}
