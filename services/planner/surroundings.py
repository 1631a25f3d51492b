"""What twelve distances say about the way to a node that is only known by its bearing and disparity."""

import math
from collections.abc import Sequence

import numpy as np

from services.planner.profiles import Profile
from services.planner.similarity import apart_rad
from shared.geometry.clearance import Obstacles
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


def length_m(match: NodeMatch, profile: Profile) -> float:
    """Rough length of the way to a node: disparity grows with distance, faster in rooms than in yards."""
    disparity_rad = match.disparity_rad if match.disparity_rad is not None else 0.0
    return apart_rad(disparity_rad, match.inliers, profile) / profile.sensing.disparity_rad_per_m


def is_clear(match: NodeMatch, ranges: Ranges, profile: Profile) -> bool:
    """Whether the sensors see free ground all the way to the matched node."""
    return _is_free_for(length_m(match, profile), match, ranges, profile)


def is_surely_clear(match: NodeMatch, ranges: Ranges, profile: Profile) -> bool:
    """The same where the matched node may be as far away as nodes with so few matches are."""
    most_m = (
        profile.sensing.unsure_m / max(match.inliers, 1) if match.inliers < profile.mapping.s_sure else 0.0
    )
    return _is_free_for(max(most_m, length_m(match, profile)), match, ranges, profile)


def is_half_clear(match: NodeMatch, ranges: Ranges, profile: Profile) -> bool:
    """Whether nothing stands on the nearer half of the way to the matched node.

    Disparity tells a distance to a factor of about two (0.06 to 0.24 rad a metre in an office):
    where `is_clear` cannot be told, this tells a way that was free before from one that is shut now.
    """
    if match.status == "no_baseline":
        return True
    if match.heading_rad is None:
        return False
    return free_way_m(ranges, match.heading_rad, profile) >= 0.5 * length_m(match, profile)


def _is_free_for(leg_m: float, match: NodeMatch, ranges: Ranges, profile: Profile) -> bool:
    if match.status == "no_baseline":
        return True
    if match.heading_rad is None or match.disparity_rad is None:
        return False
    obstacles = Obstacles.from_ranges(ranges.angles_rad, ranges.distances_m, ranges.max_range_m)
    free_m = obstacles.clearance_m(np.array([match.heading_rad]), profile.sensing.robot_radius_m)[0]
    return bool(leg_m <= free_m + profile.sensing.robot_radius_m)


def is_clear_from(node: Node, match: NodeMatch, profile: Profile) -> bool:
    """Whether the way from a node to the picture that was matched with it is free, as the node remembers."""
    if match.heading_rad is None or match.yaw_rad is None or match.disparity_rad is None:
        return match.status == "no_baseline"
    back_rad = match.heading_rad + math.pi - match.yaw_rad
    sector = round(back_rad / SECTOR_RAD) % SECTORS
    return (
        node.open[sector]
        and length_m(match, profile) <= profile.sensing.opening_m + profile.sensing.robot_radius_m
    )
