"""What the distance sensors saw of the floor at each node and on the ways out of it. Pure.

A beam of 30 degrees (decision 0006) reads the nearest thing in it: all floor before that is free, and what
lies behind it is a wall's other side or the room past a door. From afar a door shows in no beam, as the wall
beside it is nearer; from close by a beam fits through it. So a wall that the robot went along has no door
where none showed, and one seen from afar may have one. Where nodes cover so much that ways do not come close
to every wall, walls are located by several beams (`wall_spots`).
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from services.planner.echoes import by_sector_m
from services.planner.mapping.frontiers.wall_spots import ray_of, sector_towards, wall_spots, walls_along_rays
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.relative_poses import RelativePose
from shared.messages.base import SECTORS
from shared.messages.sensors import Ranges

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]
IndexArray = npt.NDArray[np.intp]

OCCLUDED = 0.5
"""What floor counts that nobody saw, where there may be a way to it; chosen. Where walls are located and it
is behind none, it counts in full: little of what lies past a passage can be looked at."""
APART_M = 0.2
"""The robot goes as far from one view to the next; chosen: a quarter of a narrow door."""
DOOR_SEEN_M = 1.3
"""From so near a beam fits through a door: there it is 0.7 m wide, and a door that one can pass has 0.82."""
WALL_VIEWS = 3
"""So many views from close by show a wall; chosen: 0.4 m along it. One alone may show the frame of a door, or
a table beside a passage."""
WALL_M = 1.0
"""How far behind such an echo no floor counts; chosen: beyond, other views tell."""
BESIDE_M = 0.4
"""Floor this near to floor that was seen may belong to it; chosen: half a narrow door."""
RING_M = BESIDE_M * np.array([[math.cos(turn), math.sin(turn)] for turn in np.arange(8) * math.tau / 8])


@dataclass(frozen=True)
class Views:
    """What was seen from around a node, in one frame.

    Attributes:
        seen: (V, 3 + SECTORS) position, yaw and readings.
        walls_m: (V, RAYS) how far the nearest wall is along each ray; None where they are not located.
    """

    seen: FloatArray
    walls_m: FloatArray | None = None


class FloorViews:
    """Views by node, each as it was seen from there; lives as long as a mission.

    Attributes:
        range_m: how far the sensors reach; 0 before the first view.
        gains: the most new floor that a direction of a node leads to, as it was last judged (`floor_gain`).
    """

    def __init__(self, robot_radius_m: float) -> None:
        self._radius_m = robot_radius_m
        self._views: dict[int, list[FloatArray]] = {}
        self._walls: dict[int, tuple[int, FloatArray]] = {}  # of so many views
        self.range_m = 0.0
        self.gains: dict[int, float] = {}

    def add(self, here: Displacement, ranges: Ranges) -> None:
        """Keep a view, unless one from that node was taken hardly elsewhere.

        A spot passed again, at another departure say, shows no more of a wall.
        """
        self.range_m = ranges.max_range_m
        views = self._views.setdefault(here.node_id, [])
        if any(math.dist(view[:2], (here.x_m, here.y_m)) < APART_M for view in views):
            return
        views.append(np.array([here.x_m, here.y_m, here.yaw_rad, *by_sector_m(ranges)]))

    def cover(self, node_id: int) -> bool:
        """Whether anything was seen from a node."""
        return node_id in self._views

    def weights(self, floor_m: FloatArray, views: Views, covers_m: float) -> FloatArray:
        """What floor counts: 1 where it was seen, 0 behind walls, between them where there may be a way.

        Args:
            floor_m: (N, 2) in the frame of the views.
            views: those `around` a node.
            covers_m: as far behind what was seen from afar there may be floor.

        Returns:
            (N,).
        """
        seen, hidden = self._looked_at(floor_m, views, covers_m)
        rest = ~seen & ~hidden
        beside = self._seen((floor_m[rest, None] + RING_M).reshape(-1, 2), views)
        hidden[rest] = beside.reshape(-1, len(RING_M)).any(axis=1)
        return np.where(seen, 1.0, np.where(hidden, OCCLUDED if views.walls_m is None else 1.0, 0.0))

    def around(self, poses: Mapping[int, RelativePose], covers_m: float) -> Views:
        """All views from these nodes, in one frame.

        Args:
            poses: of the nodes.
            covers_m: how far around a node floor counts as known; where that is more than DOOR_SEEN_M, ways
                do not lead along every wall, and walls are located.
        """
        seen, spots = [np.zeros((0, 3 + SECTORS))], [np.zeros((0, 2))]
        for node_id in (node_id for node_id in poses if node_id in self._views):
            pose, views = poses[node_id], np.array(self._views[node_id])
            cos, sin = math.cos(pose.yaw_rad), math.sin(pose.yaw_rad)
            turn = np.array([[cos, sin], [-sin, cos]])
            if covers_m > DOOR_SEEN_M:
                spots.append(self._spots(node_id, views) @ turn + pose.position_m)
            views[:, :2] = views[:, :2] @ turn + pose.position_m
            views[:, 2] += pose.yaw_rad
            seen.append(views)
        together = np.concatenate(seen)
        if covers_m <= DOOR_SEEN_M:
            return Views(together)
        return Views(together, walls_along_rays(together, np.concatenate(spots), self._radius_m))

    def _spots(self, node_id: int, views: FloatArray) -> FloatArray:
        """(M, 2) of walls, in the node's frame."""
        count, spots = self._walls.get(node_id, (0, views[:0, :2]))
        if count != len(views):
            spots = wall_spots(views, self._radius_m, self.range_m)
            self._walls[node_id] = len(views), spots
        return spots

    def _seen(self, floor_m: FloatArray, views: Views) -> BoolArray:
        """(N,) whether any view saw it."""
        floor, away_m, echo_m, _ = _echoes_beside(floor_m, views, -self._radius_m)
        seen = floor[away_m <= echo_m - self._radius_m]
        return np.bincount(seen, minlength=len(floor_m)) > 0

    def _looked_at(self, floor_m: FloatArray, views: Views, covers_m: float) -> tuple[BoolArray, BoolArray]:
        """(N,) each: seen by any view; else behind what was seen, and not behind a wall."""
        floor, away_m, echo_m, wall_m = _echoes_beside(floor_m, views, max(covers_m, WALL_M))
        seen = away_m <= echo_m - self._radius_m
        near = echo_m <= DOOR_SEEN_M
        blocked = ~seen & near & (away_m <= echo_m + WALL_M)
        hidden = blocked | (~seen & ~near & (away_m <= np.minimum(echo_m + covers_m, wall_m)))
        views_that = (np.bincount(floor[w], minlength=len(floor_m)) for w in (seen, hidden, blocked))
        saw, may_hide, show_wall = views_that
        return saw > 0, (saw == 0) & (may_hide > 0) & (show_wall < WALL_VIEWS)


def _echoes_beside(
    floor_m: FloatArray, views: Views, beyond_m: float
) -> tuple[IndexArray, FloatArray, FloatArray, FloatArray]:
    """Spots and views no further apart than its longest reading and `beyond_m`.

    Returns:
        (K,) each: index of the spot, distance, what the sensor towards it read, how far a wall lies that way.
    """
    seen = views.seen
    echoes_m = seen[:, 3:]
    at_m, reach_m = seen[:, :2], np.maximum(echoes_m.max(axis=1, initial=0.0) + beyond_m, 0.0)
    apart_m2 = (floor_m**2).sum(axis=1)[:, None] + (at_m**2).sum(axis=1) - 2.0 * floor_m @ at_m.T
    floor, view = np.nonzero(apart_m2 <= reach_m**2)
    offset = floor_m[floor] - at_m[view]
    sector = sector_towards(offset, seen[view, 2])
    wall_m = np.full(len(view), np.inf) if views.walls_m is None else views.walls_m[view, ray_of(offset)]
    return floor, np.hypot(offset[:, 0], offset[:, 1]), echoes_m[view, sector], wall_m
