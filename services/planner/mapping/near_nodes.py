"""What a robot sees of the nodes around the one it came from, and where it is by that."""

import math

from services.planner.mapping.edges import CONFIDENCE_MIN, NewEdges
from services.planner.mapping.reach import distances, elsewhere, in_reach, nodes_nearby
from services.planner.ports import MapAccess, Matcher, Matches
from services.planner.profiles import Profile
from services.planner.similarity import trusted
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.messages.matching import NodeMatch
from shared.motion.motion import Motion

COMPARED = 5
"""The node left and the neighbours most similar to it; chosen: they surround the first metres of the way."""

TURN_RAD = math.radians(15.0)
"""A robot turns less than that between two frames beside what it knows; chosen: half a radian a second."""


class NearNodes:
    """Follows the robot from one node on.

    Attributes:
        here: where it is relative to that node, by what it did and what it saw of the node.
    """

    def __init__(self, profile: Profile, maps: MapAccess, matcher: Matcher, start: Displacement) -> None:
        self._profile, self._maps, self._matcher = profile, maps, matcher
        self.here = start

    @property
    def node_id(self) -> int:
        """The node it came from."""
        return self.here.node_id

    def moved(self, motion: Motion) -> None:
        """The robot moved on."""
        self.here = self.here.moved(motion)

    def seen(self) -> Matches:
        """The nodes around that lie where they are seen: the two sides of a desk island look the same."""
        matches = self._matcher.match(self._around(), 0)
        away = set(elsewhere(self._maps.graph, matches, self.here, self._profile))
        origin = matches.get(self.node_id)
        if origin is not None and self._profile.sensing.similarity == "verified" and self._jumped(origin):
            away.add(self.node_id)
        return {node: match for node, match in matches.items() if node not in away}

    def candidates(self) -> Matches:
        """Nodes that may get an edge: the most similar ones, or the newest (thesis section 6.1.1)."""
        newest = self._profile.mapping.edge_window
        if not newest:
            count = self._profile.mapping.edge_candidates
            around = nodes_nearby(self._maps.graph, self.here, self._profile, count)
            return self._matcher.match(around, count)
        return self._matcher.match(sorted(self._maps.graph.nodes)[-newest:], 0)

    def locate(self, origin: NodeMatch | None) -> float | None:
        """Where the view of the node and a sure bearing put the robot.

        Returns:
            The yaw of the node's camera in the robot's frame; None where the view does not tell it.
        """
        if origin is None or origin.yaw_rad is None or not trusted(origin, self._profile):
            return None
        sure = origin.confidence >= CONFIDENCE_MIN
        self.here = self.here.turned(origin.yaw_rad, origin.heading_rad if sure else None)
        return origin.yaw_rad

    def is_crowded(self, matches: Matches) -> bool:
        """Whether a node that is seen lies too near for another one: where desks repeat views change fast."""
        if not self._profile.mapping.node_apart_m:
            return False
        apart_m = distances(self._maps.graph, self.here, matches)
        return min(apart_m.values(), default=math.inf) < self._profile.mapping.node_apart_m

    def credible(self, matches: Matches, edges: NewEdges) -> Matches:
        """What the robot surely sees: the node left, nodes that lie where they are seen, those of edges."""
        if self._profile.sensing.similarity == "raw":
            return matches
        within = in_reach(self._maps.graph, matches, self.here, self._profile)
        sure = {self.node_id, *within, *edges.admitted}
        return {node: match for node, match in matches.items() if node in sure}

    def _jumped(self, origin: NodeMatch) -> bool:
        """Whether the node left is seen as if the robot had turned at once, be its bearing sure or not."""
        if origin.yaw_rad is None or not trusted(origin, self._profile):
            return False
        miss_rad = abs(math.remainder(origin.yaw_rad + self.here.yaw_rad, math.tau))
        return miss_rad > TURN_RAD + self.here.yaw_std_rad

    def _around(self) -> list[int]:
        graph = self._maps.graph
        around = sorted(graph.neighbours(self.node_id), key=lambda n: -_inliers(graph, self.node_id, n))
        return [self.node_id, *around[: COMPARED - 1]]


def _inliers(graph: MapGraph, first: int, second: int) -> int:
    edge = graph.edge(first, second)
    return edge.inliers if edge is not None else 0
