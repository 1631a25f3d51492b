"""In which part of the map the robot is, where equal houses resemble the view too. Pure."""

from collections.abc import Mapping

from services.planner.closures import FAR_HOPS
from services.planner.graph import MapGraph
from services.planner.profiles import Profile
from services.planner.similarity import similarity, trusted
from shared.messages.matching import NodeMatch


def places_around(graph: MapGraph, matches: Mapping[int, NodeMatch], profile: Profile) -> set[int]:
    """The matched places of the part of the map whose places resemble the view most in all.

    Beside the robot several places resemble the view, each for itself; a look-alike elsewhere stands alone,
    or its neighbours fit less. Everything is one part where `s_far` does not ask for such care.

    Args:
        graph: the map.
        matches: the current frame against places of the map.
        profile: thresholds.
    """
    if not profile.s_far:
        return set(matches)
    seen = {
        node: similarity(match, profile)
        for node, match in matches.items()
        if node in graph.nodes and trusted(match, profile) and similarity(match, profile) > profile.s_via_min
    }
    parts = [graph.within(node, FAR_HOPS) & seen.keys() for node in sorted(seen)]
    return max(parts, key=lambda part: sum(seen[node] for node in part), default=set())
