"""How much floor a direction of a node leads to that no node around covers. Pure."""

import math
from collections.abc import Mapping, Sequence
from functools import cache, reduce

import numpy as np
import numpy.typing as npt

from services.planner.mapping.floor_views import OCCLUDED, FloorViews, Views
from services.planner.mapping.wall_spots import sector_towards
from services.planner.profiles import Profile
from services.planner.surroundings import free_ways_m
from shared.mapgraph.frontiers import SECTOR_RAD, frontier_sectors, mark_explored, sector_rad
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.relative_poses import RelativePose, relative_poses
from shared.mapgraph.local.view_range import edge_length_m, openness
from shared.messages.base import SECTORS
from shared.messages.maps import Node
from shared.messages.sensors import Ranges

FloatArray = npt.NDArray[np.float64]
ACROSS = 13
"""Points across the disc that a node covers; chosen: 130 in all, so that 1 % of it counts."""
ROOM_COVERS_M = 1.0
"""How far around a node floor counts as known in a room, unless a mission says otherwise; chosen."""
STRAIGHT_SHARE = 0.25
"""Share of its gain that a direction loses which turns the robot round; chosen: of two that are as good the
one ahead comes first."""
VIEWED_SHARE = 0.375
"""Of what distance sensors reach: where nodes cover more, floor is looked for beyond that (AHEAD), and free
ways tell more."""
AHEAD = (1.0, 2.0)
"""Where new floor is looked for along a free direction, in radii that a node covers; chosen: through a door
that is one away, floor begins behind the walls beside it."""
SIDE_FACTOR = AHEAD[-1] + 1.5
"""So many times as far as a node covers, over free ground, lie the nodes whose floor is on the same side of
every wall; chosen: beyond one radius more than the farthest floor looked at, little is covered."""


def without_poor_directions(graph: MapGraph, root: int, profile: Profile, views: FloorViews) -> list[Node]:
    """Nodes around one that have less to explore than they say: what lies there is known.

    Args:
        graph: the map.
        root: the node just added.
        profile: how far a node covers, and the share of that which a new one must add.
        views: what was seen from the nodes; gets what their directions lead to.

    Returns:
        Those nodes, with the directions explored that are not worth the way.
    """
    covers_m = covered_m(graph, root, profile)
    if not covers_m:
        return []
    poses = _poses_around(graph, root)
    seen = views.around(poses, covers_m)
    near = [n for n, pose in poses.items() if np.linalg.norm(pose.position_m) < (AHEAD[-1] + 2.0) * covers_m]
    changed = []
    for node in (graph.nodes[node_id] for node_id in near):
        gains = _gains(graph, poses, node, covers_m, views, seen)
        if gains:
            views.gains[node.node_id] = max(gains.values())
        poor = [sector for sector, gain in gains.items() if gain < profile.mapping.gain_min]
        if poor:
            changed.append(reduce(mark_explored, poor, node))
    return changed


def covered_m(graph: MapGraph, node_id: int, profile: Profile) -> float:
    """How far around a node floor counts as known; 0 where every direction is to be explored."""
    if profile.mapping.covers_m is not None:
        return profile.mapping.covers_m
    return ROOM_COVERS_M * openness(graph, node_id)


def best_sector(
    graph: MapGraph,
    node_id: int,
    sectors: Sequence[int],
    preferred_rad: float,
    profile: Profile,
    views: FloorViews,
) -> int | None:
    """The direction of a node with most new floor, rather about a preferred one; None without any.

    Args:
        graph: the map.
        node_id: the node.
        sectors: its unexplored directions to choose from.
        preferred_rad: where the robot goes already, in the node's camera frame.
        profile: how far a node covers.
        views: what was seen from the nodes.
    """

    def worth(sector: int) -> tuple[float, int]:
        turn_rad = abs(math.remainder(sector_rad(sector) - preferred_rad, math.tau))
        return round(gains[sector] * (1.0 - STRAIGHT_SHARE * turn_rad / math.pi), 6), -sector

    node, covers_m = graph.nodes[node_id], covered_m(graph, node_id, profile)
    gains = dict.fromkeys(sectors, 1.0)
    if covers_m and sectors:
        poses = _poses_around(graph, node_id)
        worths = _gains(graph, poses, node, covers_m, views, views.around(poses, covers_m))
        gains = {sector: worths[sector] for sector in sectors}
    return max(gains, key=worth, default=None)


def gain_here(
    graph: MapGraph, here: Displacement, ranges: Ranges, profile: Profile, views: FloorViews
) -> float:
    """New floor around the robot, which no node covers (`_gain`); 0 where every direction is to be explored.

    Args:
        graph: the map.
        here: where the robot is.
        ranges: the distances here.
        profile: how far a node covers.
        views: what was seen from the nodes, and on the way here.
    """
    covers_m = covered_m(graph, here.node_id, profile)
    if not covers_m:
        return 0.0
    poses = _poses_around(graph, here.node_id)
    known_m = _known_m(graph, poses, here.node_id, covers_m)
    spot = np.array([here.x_m, here.y_m])
    new = _new_floor_m(known_m, spot, covers_m)
    if covers_m <= VIEWED_SHARE * views.range_m:
        return _gain(views.weights(new, views.around(poses, covers_m), covers_m), covers_m)
    return _gain(_weights(new - spot, here.yaw_rad, np.array(free_ways_m(ranges, profile))), covers_m)


def _poses_around(graph: MapGraph, node_id: int) -> dict[int, RelativePose]:
    return relative_poses(graph, node_id, graph.nearest(node_id, NEAR_NODES), NEAR_NODES)


def _gains(
    graph: MapGraph,
    poses: Mapping[int, RelativePose],
    node: Node,
    covers_m: float,
    views: FloorViews,
    seen: Views,
) -> dict[int, float]:
    sectors = frontier_sectors(node)
    if not sectors:
        return {}
    known_m, own = _known_m(graph, poses, node.node_id, covers_m), poses[node.node_id]
    free_m = node.free_m or (covers_m,) * SECTORS

    def weights(floor_m: FloatArray) -> FloatArray:
        if views.cover(node.node_id) and covers_m <= VIEWED_SHARE * views.range_m:
            return views.weights(floor_m, seen, covers_m)
        return _weights(floor_m - own.position_m, own.yaw_rad, np.array(free_m))

    gains: dict[int, float] = {}
    for sector in sectors:
        angle_rad = own.yaw_rad + sector * SECTOR_RAD
        way = np.array([math.cos(angle_rad), math.sin(angle_rad)])
        spots = [own.position_m + min(ahead * covers_m, free_m[sector]) * way for ahead in AHEAD]
        spots[1:] = [spot for spot in spots[1:] if not _seen_nearer(graph, poses, node.node_id, spot)]
        floors = [_new_floor_m(known_m, spot, covers_m) for spot in spots]
        gains[sector] = 0.0
        for floor in sorted(floors, key=len, reverse=True):
            if _gain(np.ones(len(floor)), covers_m) <= gains[sector]:
                break  # it counts no more even where all of it was seen
            gains[sector] = max(gains[sector], _gain(weights(floor), covers_m))
    return gains


def _seen_nearer(
    graph: MapGraph, poses: Mapping[int, RelativePose], node_id: int, spot_m: FloatArray
) -> bool:
    """Whether another node is nearer to a spot and its sensors saw free floor up to there: its to explore."""
    far_m = np.linalg.norm(spot_m - poses[node_id].position_m)
    for other, pose in poses.items():
        offset, free_m = spot_m - pose.position_m, graph.nodes[other].free_m
        if other == node_id or np.linalg.norm(offset) >= far_m:
            continue
        if not free_m or _saw(offset, pose.yaw_rad, np.array(free_m)):
            return True
    return False


def _known_m(graph: MapGraph, poses: Mapping[int, RelativePose], node_id: int, covers_m: float) -> FloatArray:
    """(N, 2) positions of the nodes on a node's side of the walls."""
    beside = _on_this_side(graph, node_id, SIDE_FACTOR * covers_m)
    return np.array([poses[n].position_m for n in beside if n in poses])


def _new_floor_m(known_m: FloatArray, spot_m: FloatArray, covers_m: float) -> FloatArray:
    """(M, 2) points of the disc around a spot (2,) which none of the nodes at `known_m` (N, 2) covers."""
    floor = spot_m + covers_m * _disc()
    gaps = np.linalg.norm(floor[:, None] - known_m[None], axis=2)
    return np.asarray(floor[(gaps > covers_m).all(axis=1)])


def _gain(counts: FloatArray, covers_m: float) -> float:
    """New floor by what its points count: as a share of the disc in a room, where nodes cover more of more.

    A flat is twenty discs of one metre, a yard two of four metres: there the same share is a passage missed.
    """
    return math.sqrt(max(1.0, covers_m / ROOM_COVERS_M)) * float(counts.sum()) / len(_disc())


def _weights(offset: FloatArray, own_yaw_rad: float, free_m: FloatArray) -> FloatArray:
    """What floor counts beside a node without views: 1 where its free ways lead, by its offset from it."""
    return np.where(_saw(offset, own_yaw_rad, free_m), 1.0, OCCLUDED)


def _saw(offset: FloatArray, own_yaw_rad: float, free_m: FloatArray) -> npt.NDArray[np.bool_]:
    """Whether floor was free as far as there, by its offsets (..., 2) from the sensors."""
    return np.asarray(np.linalg.norm(offset, axis=-1) <= free_m[sector_towards(offset, own_yaw_rad)])


def _on_this_side(graph: MapGraph, start: int, far_m: float) -> set[int]:
    """Nodes that at most so many metres of free ground join to one, itself among them."""
    return graph.within_cost(
        start, far_m, lambda edge: edge_length_m(graph, edge) if edge.clear or edge.traversals else None
    )


@cache
def _disc() -> FloatArray:
    """Points spread evenly over the unit disc."""
    side = np.linspace(-1.0, 1.0, ACROSS)
    x, y = np.meshgrid(side, side)
    inside = np.hypot(x, y) <= 1.0
    return np.stack([x[inside], y[inside]], axis=1)
