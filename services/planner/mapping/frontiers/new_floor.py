"""A node and those around it in one frame: how much floor that none of them covers lies beside them. Pure."""

import math
from functools import cache, cached_property

import numpy as np
import numpy.typing as npt

from services.planner.mapping.frontiers.floor_views import OCCLUDED, FloorViews, Views
from services.planner.mapping.frontiers.wall_spots import sector_towards
from shared.mapgraph.frontiers import SECTOR_RAD, frontier_sectors
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.relative_poses import relative_poses
from shared.mapgraph.local.view_range import edge_length_m
from shared.messages.base import SECTORS
from shared.messages.maps import Edge, Node

FloatArray = npt.NDArray[np.float64]
ACROSS = 13
"""Points across the disc that a node covers; chosen: 130 in all, so that 1 % of it counts."""
ROOM_COVERS_M = 1.0
"""How far around a node floor counts as known in a room, unless a mission says otherwise; chosen."""
VIEWED_SHARE = 0.375
"""Of what distance sensors reach: where nodes cover more, floor is looked for beyond that (AHEAD), and free
ways tell more."""
AHEAD = (1.0, 2.0)
"""Where new floor is looked for along a free direction, in radii that a node covers; chosen: through a door
that is one away, floor begins behind the walls beside it."""
SIDE_FACTOR = AHEAD[-1] + 1.5
"""So many times as far as a node covers, over free ground, lie the nodes whose floor is on the same side of
every wall; chosen: beyond one radius more than the farthest floor looked at, little is covered."""
JUDGED_FACTOR = AHEAD[-1] + 2.0
"""Nodes so many times as far away as a node covers may lead to less new floor than before a node was added;
chosen: as far as their floor and its own can overlap, and one radius."""


class Neighbourhood:
    """What is known of the floor around a node.

    Args:
        graph: the map.
        root: the node.
        covers_m: how far around a node floor counts as known.
        views: what was seen from the nodes and on the ways out of them.
    """

    def __init__(self, graph: MapGraph, root: int, covers_m: float, views: FloorViews) -> None:
        self._graph, self._covers_m, self._views = graph, covers_m, views
        self._poses = relative_poses(graph, root, graph.nearest(root, NEAR_NODES), NEAR_NODES)
        self._views_tell = covers_m <= VIEWED_SHARE * views.range_m

    def nodes(self) -> list[Node]:
        """Those whose directions may lead to what the root covers."""
        far_m = JUDGED_FACTOR * self._covers_m
        return [self._graph.nodes[n] for n, p in self._poses.items() if np.linalg.norm(p.position_m) < far_m]

    def gains(self, node: Node) -> dict[int, float]:
        """New floor that each unexplored direction of a node leads to (`_gain`)."""
        sectors = frontier_sectors(node)
        known_m = self._known_m(node.node_id) if sectors else np.zeros((0, 2))
        return {sector: self._gain_towards(node, sector, known_m) for sector in sectors}

    def gain_here(self, here: Displacement, free_m: FloatArray) -> float:
        """New floor (`_gain`) around the robot, which is beside the root and has free ways (SECTORS,)."""
        spot = np.array([here.x_m, here.y_m])
        new = self._new_floor_m(self._known_m(here.node_id), spot)
        if self._views_tell:
            return self._gain(self._views.weights(new, self._seen, self._covers_m))
        return self._gain(_weights(new - spot, here.yaw_rad, free_m))

    @cached_property
    def _seen(self) -> Views:
        return self._views.around(self._poses, self._covers_m)

    def _gain_towards(self, node: Node, sector: int, known_m: FloatArray) -> float:
        own, covers_m = self._poses[node.node_id], self._covers_m
        free_m = np.array(node.free_m or (covers_m,) * SECTORS)
        angle_rad = own.yaw_rad + sector * SECTOR_RAD
        way = np.array([math.cos(angle_rad), math.sin(angle_rad)])
        spots = [own.position_m + min(ahead * covers_m, free_m[sector]) * way for ahead in AHEAD]
        spots[1:] = [spot for spot in spots[1:] if not self._seen_nearer(node.node_id, spot)]
        floors = [self._new_floor_m(known_m, spot) for spot in spots]
        most = 0.0
        for floor in sorted(floors, key=len, reverse=True):
            if self._gain(np.ones(len(floor))) <= most:
                break  # it counts no more even where all of it was seen
            if self._views_tell and self._views.cover(node.node_id):
                weights = self._views.weights(floor, self._seen, covers_m)
            else:
                weights = _weights(floor - own.position_m, own.yaw_rad, free_m)
            most = max(most, self._gain(weights))
        return most

    def _seen_nearer(self, node_id: int, spot_m: FloatArray) -> bool:
        """Whether another node is nearer to a spot, which is its to explore, and saw free floor so far."""
        far_m = np.linalg.norm(spot_m - self._poses[node_id].position_m)
        for other, pose in self._poses.items():
            offset, free_m = spot_m - pose.position_m, self._graph.nodes[other].free_m
            if other == node_id or np.linalg.norm(offset) >= far_m:
                continue
            if not free_m or _saw(offset, pose.yaw_rad, np.array(free_m)):
                return True
        return False

    def _known_m(self, node_id: int) -> FloatArray:
        """(N, 2) positions of the nodes on a node's side of the walls: free ground joins them to it."""

        def free_way_m(edge: Edge) -> float | None:
            return edge_length_m(self._graph, edge) if edge.clear or edge.traversals else None

        beside = self._graph.within_cost(node_id, SIDE_FACTOR * self._covers_m, free_way_m)
        return np.array([self._poses[n].position_m for n in beside if n in self._poses])

    def _new_floor_m(self, known_m: FloatArray, spot_m: FloatArray) -> FloatArray:
        """(M, 2) points of the disc around a spot (2,) which none of the nodes at `known_m` (N, 2) covers."""
        floor = spot_m + self._covers_m * _disc()
        gaps = np.linalg.norm(floor[:, None] - known_m[None], axis=2)
        return np.asarray(floor[(gaps > self._covers_m).all(axis=1)])

    def _gain(self, counts: FloatArray) -> float:
        """New floor by what its points count: as a share of the disc, and of more where nodes cover more.

        A flat is twenty discs of one metre, a yard two of four: there the same share is a passage missed.
        """
        return math.sqrt(max(1.0, self._covers_m / ROOM_COVERS_M)) * float(counts.sum()) / len(_disc())


def _weights(offset: FloatArray, own_yaw_rad: float, free_m: FloatArray) -> FloatArray:
    """What floor counts beside a node without views: 1 where its free ways lead, by its offset from it."""
    return np.where(_saw(offset, own_yaw_rad, free_m), 1.0, OCCLUDED)


def _saw(offset: FloatArray, own_yaw_rad: float, free_m: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether floor was free as far as there, by its offsets (..., 2) from the sensors."""
    return np.asarray(np.linalg.norm(offset, axis=-1) <= free_m[sector_towards(offset, own_yaw_rad)])


@cache
def _disc() -> FloatArray:
    """Points spread evenly over the unit disc."""
    side = np.linspace(-1.0, 1.0, ACROSS)
    x, y = np.meshgrid(side, side)
    inside = np.hypot(x, y) <= 1.0
    return np.stack([x[inside], y[inside]], axis=1)
