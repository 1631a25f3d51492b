"""Unexplored directions of nodes by which the rules of the map let a robot leave."""

import math

from services.planner.ports import MapAccess
from shared.mapgraph.frontiers import frontier_sectors
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.keep_clear import keep_clear
from shared.mapgraph.local.view_range import openness

AHEAD_M = 0.4
"""Looked ahead during a departure; chosen: three steps, of which the last frame does not know yet."""


class AllowedDirections:
    """Directions of one map during one mission; those that led to a keep-out after all are not tried again.

    The map is not told: when the rule is lifted, they are there to be explored.
    """

    def __init__(self, maps: MapAccess) -> None:
        self._maps = maps
        self._refused: set[tuple[int, int]] = set()

    def of(self, node_id: int) -> list[int]:
        """Sectors of a node; none of a forbidden one."""
        limits = self._maps.limits()
        if node_id in limits.forbidden:
            return []
        barred = limits.directions.get(node_id, ())
        sectors = frontier_sectors(self._maps.graph.nodes[node_id])
        return [s for s in sectors if s not in barred and (node_id, s) not in self._refused]

    def refuse(self, node_id: int, sector: int) -> None:
        """A departure met a keep-out."""
        self._refused.add((node_id, sector))

    def ahead(self, here: Displacement, heading_rad: float) -> str:
        """Name of the rule that lets the robot not go on; "" where none does.

        Args:
            here: where it is.
            heading_rad: where it goes, in its own frame.
        """
        graph, forbidden = self._maps.graph, self._maps.limits().forbidden
        if not forbidden or here.node_id not in graph.nodes:
            return ""
        around = keep_clear(graph, here.node_id, forbidden)
        if around is None:
            return ""
        angle_rad, reach_m = here.yaw_rad + heading_rad, AHEAD_M * openness(graph, here.node_id)
        start_m = (here.x_m, here.y_m)
        end_m = (here.x_m + reach_m * math.cos(angle_rad), here.y_m + reach_m * math.sin(angle_rad))
        if not around.is_crossed(start_m, end_m):
            return ""
        return next(forbidden[node] for node in around.poses if node in forbidden)
