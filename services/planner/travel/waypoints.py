"""When a waypoint is reached, and when a later one is headed for instead (thesis equation 4.3). Pure."""

from services.planner.profiles import Profile
from services.planner.similarity import apart_rad, close_enough, similarity, trusted
from services.planner.surroundings import is_clear
from shared.messages.matching import NodeMatch
from shared.messages.sensors import Ranges

SLOW_M = 1.33
"""Where the robot begins to slow down; chosen: at 0.12 m a step it would pass the 0.1 m of `arrival_rad`."""

SLOWEST = 0.15
"""Least share of full speed; chosen: 2 cm a step, a fifth of the arrival distance."""


def is_strict(profile: Profile) -> bool:
    """Whether waypoints change by the thesis's rule alone, by counts and one at a time."""
    return profile.travel.path_cost == "nodes"


def is_at(match: NodeMatch | None, profile: Profile) -> bool:
    """Whether the robot stands at the waypoint: many matches agree, and bearings hardly differ."""
    if match is None or not close_enough(match, profile):
        return False
    return match.status == "no_baseline" or _nearer(match, profile.arrival.travel_arrival_rad)


def has_arrived(match: NodeMatch, profile: Profile, arrival_rad: float) -> bool:
    """Whether the end of a path is reached: by count alone (thesis), or by disparity below `arrival_rad`."""
    if similarity(match, profile) > profile.arrival.s_final:
        return True
    if arrival_rad <= 0.0 or match.inliers < profile.mapping.s_edge_min or not close_enough(match, profile):
        return False
    return match.status == "no_baseline" or (match.status == "ok" and _nearer(match, arrival_rad))


def is_near_end(match: NodeMatch, profile: Profile, arrival_rad: float) -> bool:
    """Whether a robot that comes no nearer may stop here: obstacles surround many a spot."""
    near = _nearer(match, profile.arrival.near_rad)
    return near and similarity(match, profile) > profile.arrival.s_near and arrival_rad > 0.0


def may_advance(
    here: NodeMatch | None,
    there: NodeMatch,
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
        ranges: the distances around.
        profile: thresholds.
        straight: whether free ground alone is enough; not towards a goal that resembles a wrong spot too.
        beside: whether the robot stands at the present waypoint, and what leads to the later one is known.
    """
    s_here = similarity(here, profile) if here is not None else 0
    s_there = similarity(there, profile)
    if is_strict(profile):
        return s_here > profile.travel.s_via_max and s_there > profile.travel.s_via_min
    if straight and trusted(there, profile) and is_clear(there, ranges, profile):
        return s_there > profile.mapping.s_edge_min
    return beside and s_there > profile.travel.s_via_min


def speed_fraction(match: NodeMatch, profile: Profile) -> float:
    """Slow down towards the end of a path, as disparity tells the distance, so as not to pass it."""
    if match.disparity_rad is None:
        return 1.0
    left_rad = apart_rad(match.disparity_rad, match.inliers, profile)
    return min(1.0, max(SLOWEST, left_rad / (SLOW_M * profile.sensing.disparity_rad_per_m)))


def _nearer(match: NodeMatch, disparity_rad: float) -> bool:
    return match.disparity_rad is not None and match.disparity_rad < disparity_rad
