"""In which part of the map the robot is, where equal houses resemble the view too. Pure."""

from collections.abc import Mapping

from services.planner.closures import FAR_HOPS
from services.planner.graph import MapGraph
from services.planner.profiles import Profile
from services.planner.similarity import similarity, trusted
from shared.messages.matching import NodeMatch


def places_around(
    graph: MapGraph, matches: Mapping[int, NodeMatch], profile: Profile, last: int | None = None
) -> set[int]:
    """The matched places of one part of the map: where the robot can be.

    A robot does not jump: the part round the place it was last seen at counts, as long as one of its places
    resembles the view and it stands at no other place of the map. Without such a place the part counts whose
    places resemble the view most in all: beside the robot several do, each for itself; a look-alike elsewhere
    stands alone, or its neighbours fit less. Everything is one part where `s_far` does not ask for such care.

    Args:
        graph: the map.
        matches: the current frame against places of the map.
        profile: thresholds.
        last: where the robot was; None when it was lost or carried.
    """
    if not profile.s_far:
        return set(matches)
    seen = {
        node: similarity(match, profile)
        for node, match in matches.items()
        if node in graph.nodes and trusted(match, profile) and similarity(match, profile) > profile.s_via_min
    }
    if last in graph.nodes and last is not None:
        near = graph.within(last, FAR_HOPS) & seen.keys()
        elsewhere = max((s for node, s in seen.items() if node not in near), default=0)
        if elsewhere < profile.s_far and any(seen[node] > profile.s_edge_min for node in near):
            return near
    parts = [graph.within(node, FAR_HOPS) & seen.keys() for node in sorted(seen)]
    return max(parts, key=lambda part: sum(seen[node] for node in part), default=set())
