"""Which nodes a frame can be looking at, by what the robot did since the last one. Pure."""

import math
from collections.abc import Collection, Iterable

from services.planner.heading.choose import CONFIDENCE_MIN as HEADING_CONFIDENCE_MIN
from services.planner.ports import Matches
from services.planner.profiles import Profile
from services.planner.similarity import trusted
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import CONFIDENCE_MIN, Claim, claim_of
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import NEAR_NODES
from shared.mapgraph.local.reach import distances_m, hanging_apart, out_of_reach
from shared.mapgraph.local.view_range import openness


def claims(
    graph: MapGraph, matches: Matches, profile: Profile, confidence_min: float = CONFIDENCE_MIN
) -> dict[int, Claim]:
    """What a frame claims of nodes, where two-view geometry is sure of it."""
    sure = {node: match for node, match in matches.items() if trusted(match, profile)}
    found = {node: claim_of(graph, node, match, confidence_min) for node, match in sure.items()}
    return {node: claim for node, claim in found.items() if claim is not None}


def in_reach(graph: MapGraph, matches: Matches, here: Displacement, profile: Profile) -> Matches:
    """Matches with nodes around that lie where they are seen; what claims nothing is not among them."""
    sights = claims(graph, matches, profile, HEADING_CONFIDENCE_MIN)
    near = set(graph.nearest(here.node_id, NEAR_NODES))
    near -= out_of_reach(graph, sights, here, NEAR_NODES).keys()
    near -= hanging_apart(graph, sights, here, NEAR_NODES)
    return {node: match for node, match in matches.items() if node in sights and node in near}


def elsewhere(
    graph: MapGraph, matches: Matches, here: Displacement | None, profile: Profile
) -> dict[int, str]:
    """Nodes around that lie elsewhere than the frame claims; none where nobody knows where it was taken."""
    if here is None or profile.sensing.similarity == "raw":
        return {}
    return out_of_reach(graph, claims(graph, matches, profile), here, NEAR_NODES)


def no_edges(
    graph: MapGraph,
    matches: Matches,
    here: Displacement | None,
    profile: Profile,
    hidden: Collection[int],
) -> dict[int, str]:
    """Nodes of the whole map that lie elsewhere than the frame claims or too far for an edge, and why.

    Of those that are `hidden`, with no free ground seen up to there, it is enough to lie too far by all
    that is known: the view is one past a corner.
    """
    if here is None or profile.sensing.similarity == "raw":
        return {}
    longest_m = profile.mapping.edge_longest_m * openness(graph, here.node_id) or math.inf
    return out_of_reach(graph, claims(graph, matches, profile), here, longest_m=longest_m, hidden=hidden)


def nodes_nearby(graph: MapGraph, here: Displacement | None, profile: Profile, count: int) -> list[int]:
    """Nodes around where the robot is, to be compared with its view whatever else resembles it more."""
    if here is None or profile.sensing.similarity == "raw":
        return []
    far_m = distances_m(graph, here, NEAR_NODES)
    return sorted(far_m, key=lambda node: (far_m[node], node))[:count]


def distances(graph: MapGraph, here: Displacement, nodes: Iterable[int]) -> dict[int, float]:
    """How far nodes around are from where the robot is, metres."""
    asked = set(nodes)
    found = distances_m(graph, here, NEAR_NODES)
    return {node: far_m for node, far_m in found.items() if node in asked}
