"""What twelve distances say about the way to a node that is only known by its bearing and disparity."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from services.planner.ports import Decision
from services.planner.profiles import Profile
from shared.geometry.clearance import Obstacles
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import length_to_m, openness
from shared.messages.base import SECTORS
from shared.messages.maps import Node
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

SECTOR_RAD = math.tau / SECTORS
ASIDE_RAD = np.deg2rad([0.0, *(side * angle for angle in range(5, 35, 5) for side in (1.0, -1.0))])
"""Turns aside, the least first, up to a sector: beyond it the next direction's way begins."""
WITHIN_SECTOR_RAD = np.deg2rad(np.arange(-15.0, 16.0, 5.0))


def free_way_m(ranges: Ranges, heading_rad: float, profile: Profile) -> float:
    """How far the robot can go in about a direction: the best heading within a sector."""
    obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
    return float(obstacles.clearance_m(heading_rad + WITHIN_SECTOR_RAD, profile.sensing.robot_slim_m).max())


def through_gap(ranges: Ranges, heading_rad: float, profile: Profile) -> tuple[float, float]:
    """The heading, turned aside as little as needed to go on where it is blocked, and the free way there.

    A gap hardly wider than the robot is missed by a straight line that starts a hand's breadth beside it.
    """
    obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
    free_m = obstacles.clearance_m(heading_rad + ASIDE_RAD, profile.sensing.robot_slim_m)
    chosen = int((free_m >= min(profile.sensing.opening_m, float(free_m.max()))).argmax())
    return math.remainder(heading_rad + float(ASIDE_RAD[chosen]), math.tau), float(free_m[chosen])


def free_ways_m(ranges: Ranges, profile: Profile) -> tuple[float, ...]:
    """Per sector, how far the robot can go that way, to the centimetre; at most the sensors' range."""
    ways = (free_way_m(ranges, s * SECTOR_RAD, profile) for s in range(SECTORS))
    return tuple(round(min(free_m, ranges.max_range_m), 2) for free_m in ways)


def hidden_openings(ranges: Ranges, nodes: Sequence[tuple[Node, float]], profile: Profile) -> list[int]:
    """Ways out seen from here that none of the near nodes has: sectors of the robot frame.

    A doorway beside the way shows for a few frames only; nodes half a metre before and after it know nothing
    of it. To be worth a node of its own a way out must be clear for `doorway_m`.

    Args:
        ranges: the distances here.
        nodes: the nodes near, each with the yaw of its camera in the robot frame.
        profile: lengths that count.
    """
    found = []
    for sector in range(SECTORS):
        heading_rad = sector * SECTOR_RAD
        if free_way_m(ranges, heading_rad, profile) < profile.sensing.doorway_m:
            continue
        if not any(_knows(node, heading_rad - yaw_rad) for node, yaw_rad in nodes):
            found.append(sector)
    return found


def _knows(node: Node, heading_rad: float) -> bool:
    """Whether a node is open towards `heading_rad`, its own frame."""
    return node.open[round(heading_rad / SECTOR_RAD) % SECTORS]


def length_m(match: NodeMatch, graph: MapGraph) -> float:
    """Rough length of the way to a node or goal picture, by how much the frame has in common with it."""
    return 0.0 if match.status == "no_baseline" else length_to_m(graph, match.node_id, match.inliers)


def is_clear(match: NodeMatch, graph: MapGraph, ranges: Ranges, profile: Profile) -> bool:
    """Whether the sensors see free ground all the way to the matched node."""
    if match.status == "no_baseline":
        return True
    if match.heading_rad is None or match.disparity_rad is None:
        return False
    obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
    free_m = obstacles.clearance_m(np.array([match.heading_rad]), profile.sensing.robot_radius_m)[0]
    return bool(length_m(match, graph) <= free_m + profile.sensing.robot_radius_m)


def is_half_clear(match: NodeMatch, graph: MapGraph, ranges: Ranges, profile: Profile) -> bool:
    """Whether nothing stands on the nearer half of the way to the matched node.

    Matches tell a distance to a factor of 1.5: where `is_clear` cannot be told, this tells a way that was
    free before from one that is shut now.
    """
    if match.status == "no_baseline":
        return True
    if match.heading_rad is None:
        return False
    return free_way_m(ranges, match.heading_rad, profile) >= 0.5 * length_m(match, graph)


def is_clear_from(node: Node, match: NodeMatch, graph: MapGraph, profile: Profile) -> bool:
    """Whether the way from a node to the picture that was matched with it is free, as the node remembers."""
    if match.heading_rad is None or match.yaw_rad is None or match.disparity_rad is None:
        return match.status == "no_baseline"
    back_rad = match.heading_rad + math.pi - match.yaw_rad
    sector = round(back_rad / SECTOR_RAD) % SECTORS
    surely_m = profile.sensing.opening_m + profile.sensing.robot_radius_m
    return node.open[sector] and length_m(match, graph) <= surely_m


def at_speed(decision: Decision, graph: MapGraph, nearest: int | None, profile: Profile) -> Decision:
    """As fast as suits the place: where views carry far, things are far apart.

    Args:
        decision: of a mission, which slows down only to stop in time.
        graph: the map.
        nearest: node where the robot is; None where nobody knows.
        profile: speed in a room.
    """
    share = min(1.0, profile.travel.room_speed * openness(graph, nearest))
    return replace(decision, speed_fraction=share * decision.speed_fraction)
