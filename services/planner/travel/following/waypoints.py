"""When a waypoint is reached, and when a later one is headed for instead (thesis equation 4.3). Pure."""

import math
from collections.abc import Sequence
from itertools import pairwise

from services.planner.profiles import Profile
from services.planner.similarity import close_enough, similarity, trusted
from services.planner.surroundings import free_way_m, is_clear, length_m
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.view_range import openness
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

SLOW_M = 1.33
"""Where the robot begins to slow down; chosen: at 0.12 m a step it would pass the 0.1 m of `arrival_rad`."""

ROOM_RAD_PER_M = math.radians(9.0)
"""How fast bearings change near a picture taken in a room: 15.6 degrees at 1.75 m (`topnav calibrate`)."""

NEARER_SHARE = 0.5
"""The end is hardly nearer than this share of what matches say, however little bearings differ: far things
alone may agree, and rain or another light takes half of the matches at the very spot."""

SHUT_SHARE = 0.5
"""A way is shut where less than this share of it is free; chosen: what stands on the nearer half."""
TAKEN_M = 1.0
"""Nearer than this to a waypoint, what shuts the way stands where it is; chosen: as deep as furniture."""

SLOWEST = 0.15
"""Least share of full speed; chosen: 2 cm a step, a fifth of the arrival distance."""


def is_strict(profile: Profile) -> bool:
    """Whether waypoints change by the thesis's rule alone, by counts and one at a time."""
    return profile.travel.path_cost == "nodes"


def is_at(match: NodeMatch | None, graph: MapGraph, profile: Profile) -> bool:
    """Whether the robot stands at the waypoint: many matches agree, and bearings hardly differ."""
    if match is None or not close_enough(match, graph, profile):
        return False
    return match.status == "no_baseline" or _nearer(match, profile.arrival.travel_arrival_rad, graph)


def has_arrived(match: NodeMatch, graph: MapGraph, profile: Profile, arrival_rad: float) -> bool:
    """Whether the end of a path is reached: by count alone (thesis), or by disparity below `arrival_rad`."""
    if similarity(match, profile) > profile.arrival.s_final:
        return True
    enough = match.inliers >= profile.mapping.s_edge_min and close_enough(match, graph, profile)
    if arrival_rad <= 0.0 or not enough:
        return False
    return match.status == "no_baseline" or (match.status == "ok" and _nearer(match, arrival_rad, graph))


def is_near_end(match: NodeMatch, graph: MapGraph, profile: Profile, arrival_rad: float) -> bool:
    """Whether a robot that comes no nearer may stop here: obstacles surround many a spot."""
    near = _nearer(match, profile.arrival.near_rad, graph)
    return near and similarity(match, profile) > profile.arrival.s_near and arrival_rad > 0.0


def may_advance(
    here: NodeMatch | None,
    there: NodeMatch,
    graph: MapGraph,
    ranges: Ranges,
    profile: Profile,
    *,
    straight: bool,
    beside: bool,
) -> bool:
    """Whether to head for a later waypoint `there` instead of `here`.

    By the thesis: when the present one is very similar and the later one is seen. By default straight to a
    later one over ground that is seen free, or on to the next from a waypoint the robot stands at.

    Args:
        here: the frame against the present waypoint.
        there: the frame against the later one.
        graph: the map.
        ranges: the distances around.
        profile: thresholds.
        straight: whether free ground alone is enough; not towards a goal that resembles a wrong spot too.
        beside: whether the robot stands at the present waypoint, and what leads to the later one is known.
    """
    s_here = similarity(here, profile) if here is not None else 0
    s_there = similarity(there, profile)
    if is_strict(profile):
        return s_here > profile.travel.s_via_max and s_there > profile.travel.s_via_min
    if straight and trusted(there, profile) and is_clear(there, graph, ranges, profile):
        return s_there > profile.mapping.s_edge_min
    return beside and s_there > profile.travel.s_via_min


def way_left_m(match: NodeMatch, graph: MapGraph) -> float | None:
    """About how far a waypoint is, as disparity and matches tell; None where they do not."""
    if match.disparity_rad is None:
        return None
    by_disparity_m = openness(graph, match.node_id) * match.disparity_rad / ROOM_RAD_PER_M
    return max(by_disparity_m, NEARER_SHARE * length_m(match, graph))


def speed_fraction(left_m: float) -> float:
    """Slow down towards the end of a path."""
    return min(1.0, max(SLOWEST, left_m / SLOW_M))


def was_driven_in_vain(graph: MapGraph, way: Sequence[int]) -> bool:
    """Whether an edge along some nodes was driven in vain since it last led anywhere."""
    edges = (graph.edge(*ends) for ends in pairwise(way))
    return any(edge is not None and edge.failures > 0 for edge in edges)


def is_shut(ranges: Ranges, heading_rad: float, left_m: float, profile: Profile) -> bool:
    """Whether something stands on the nearer part of a way so long."""
    return free_way_m(ranges, heading_rad, profile) < SHUT_SHARE * left_m


def is_taken(ranges: Ranges, heading_rad: float, left_m: float | None, profile: Profile) -> bool:
    """Whether something stands where a waypoint is, which lies so far away: nobody gets there."""
    return left_m is not None and left_m <= TAKEN_M and is_shut(ranges, heading_rad, left_m, profile)


def _nearer(match: NodeMatch, disparity_rad: float, graph: MapGraph) -> bool:
    """Whether bearings differ by less than so much in a room; in the open they differ less."""
    least_rad = disparity_rad / math.sqrt(openness(graph, match.node_id))
    return match.disparity_rad is not None and match.disparity_rad < least_rad
