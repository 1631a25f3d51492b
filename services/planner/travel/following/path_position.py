"""Where on its path a robot is: which waypoint it heads for, and how far it may go. Pure."""

import math

from services.planner.mapping.reach import distances
from shared.mapgraph.graph import EdgeKey, MapGraph, edge_key
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.routing import GOAL


class PathPosition:
    """A place along a path of node ids; GOAL is last where the path ends at a picture.

    Attributes:
        path: its waypoints.
        index: of the present one, which the robot heads for.
        last: index of the last one that it may head for; beyond, others have the right of way.
    """

    def __init__(self, path: list[int]) -> None:
        self.path, self.index, self.last = path, 0, len(path) - 1
        self._passed, self._stopped_at = 0, -1

    @property
    def waypoint(self) -> int:
        """The present one."""
        return self.path[self.index]

    @property
    def next_waypoint(self) -> int:
        """The one after it."""
        return self.path[self.index + 1]

    @property
    def is_at_end(self) -> bool:
        """Whether the present waypoint is the last of the path."""
        return self.index == len(self.path) - 1

    @property
    def ahead(self) -> list[int]:
        """The present waypoint and those after it."""
        return self.path[self.index :]

    @property
    def remaining(self) -> list[int]:
        """The node left, from there on the waypoints ahead."""
        return self.path[max(0, self.index - 1) :]

    @property
    def leg(self) -> tuple[int, int]:
        """The node left and the waypoint aimed at; twice the same before the first."""
        return self.remaining[0], self.waypoint

    @property
    def edge(self) -> EdgeKey | None:
        """The edge being driven; None at index 0, where there is none (thesis equation 6.4)."""
        return edge_key(*self.leg) if self.index else None

    @property
    def next_edge(self) -> EdgeKey:
        """The edge from the present waypoint to the one after it."""
        return edge_key(self.waypoint, self.next_waypoint)

    @property
    def is_held(self) -> bool:
        """Whether the waypoints after the present one belong to others."""
        return self.last <= self.index

    @property
    def waits(self) -> bool:
        """Whether it stands where it is: the next node is not its own, and it is not on the way to one."""
        return self.last < self.index or self.last == self.index == self._stopped_at

    def stop(self) -> None:
        """The robot stands at the present waypoint, as others go first."""
        self._stopped_at = self.index

    def may_go(self, free: int, here: Displacement | None) -> None:
        """Of the way beyond so many nodes may be driven to, in the frame to come."""
        self.last = self._next(here) + free - 1

    def way(
        self, graph: MapGraph, here: Displacement | None, like: int
    ) -> tuple[tuple[int, ...], tuple[int, ...]]:
        """Nodes between which the robot is, and those of its way beyond.

        Args:
            graph: the map.
            here: where the robot is; None where nobody knows.
            like: node that stands for the goal picture.
        """
        nodes = tuple(like if node == GOAL else node for node in self.path)
        passed, ahead = nodes[self._passed : self._next(here)], nodes[self._next(here) :]
        if here is None:
            return passed, ahead
        away_m = distances(graph, here, passed)
        if not away_m:
            return (here.node_id, *passed), ahead
        nearest = min(range(len(passed)), key=lambda at: away_m.get(passed[at], math.inf))
        self._passed += nearest
        return passed[nearest:], ahead

    def _next(self, here: Displacement | None) -> int:
        """Index of the first waypoint that the robot neither stands at nor is on the way to."""
        set_off = self.index or (here is not None and here.node_id == self.path[0])
        return self.index + 1 if set_off else 0
