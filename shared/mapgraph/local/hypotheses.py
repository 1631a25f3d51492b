"""Places where a picture can have been taken: matched nodes grouped by where they put it. Pure.

Nodes of one place agree, by the edges between them, on where the picture was taken; a look-alike elsewhere
speaks for itself and its own neighbours. Without any history nothing else tells them apart.
"""

import statistics
from collections.abc import Mapping
from dataclasses import dataclass

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import Claim
from shared.mapgraph.local.displacement import seen_from
from shared.mapgraph.local.reach import SPOT_M, out_of_reach

COMPARED_NODES = 24
"""Nodes, most alike first, that a goal picture is compared with: with 16 a wrong place of a hostel had no
rival in 1 of 80 pictures, with 24 in none."""
NEAR_NODES = 60
"""Nodes of one place, nearest by edges; chosen: those within some three metres, where nodes are dense."""
CORE_NODES = 3
"""Nodes of one place, most similar first, that its core counts; chosen: those around a spot."""
SPREAD = 0.5
"""Error of a distance by matches, as a share of it (view_range)."""


@dataclass(frozen=True)
class Hypothesis:
    """One place.

    Attributes:
        nodes: those that put the picture there, most similar first.
        similarity: of the most similar one.
        support: of all of them.
        core: of the three most similar: where nodes stand denser there is not more of it.
    """

    nodes: tuple[int, ...]
    similarity: int
    support: int
    core: int = 0


def hypotheses(graph: MapGraph, claims: Mapping[int, Claim]) -> list[Hypothesis]:
    """The places that claims speak for, the one with most support first.

    Args:
        graph: the map.
        claims: what a picture says of nodes of it.
    """
    left = dict(sorted(claims.items(), key=lambda item: (-item[1].similarity, item[0])))
    left = {node: claim for node, claim in left.items() if node in graph.nodes}
    found = []
    while left:
        node, claim = next(iter(left.items()))
        far_m = claim.length_m
        here = seen_from(node, claim.heading_rad, claim.yaw_rad, far_m, SPREAD * far_m + SPOT_M / 2.0)
        near = set(graph.nearest(node, NEAR_NODES))
        elsewhere = out_of_reach(graph, left, here, NEAR_NODES)
        agreeing = {n: c for n, c in left.items() if n == node or (n in near and n not in elsewhere)}
        each = [c.similarity for c in agreeing.values()]
        found.append(Hypothesis(tuple(agreeing), claim.similarity, sum(each), sum(each[:CORE_NODES])))
        left = {n: c for n, c in left.items() if n not in agreeing}
    return sorted(found, key=lambda one: (-one.support, -one.similarity, one.nodes))


RIVAL_SHARE, RIVAL_CORE_SHARE = 0.5, 0.6
"""Another place with this share of the likeliest one's support, or of the greatest core, may be it as well.
Of 420 pictures taken anywhere in two maps of a hostel of equal rooms and one of an office of equal desks none
without such a rival was put at a wrong place; by 0.6 of the support alone two of 207 were, and a goal of a
round by half of it: in a room where a node stood nearer."""
LISTED_SHARE = 0.45
"""Places down to this share are named, once there is a rival: the right one was among them in all of the
others, by support or by the core; at 0.5 in all but one. It was not in one of 40 pictures taken later, in a
room whose nodes stand 0.7 m from the spot, where those of a twin stand 0.2 m from it."""
PLAIN_FACTOR = 1.2
"""A place alone is plain where its best node has this many times the matches of neighbours on a driven way.
Of 137 pictures whose place had no rival 130 have; of 160 without their place in the map 5 have."""


def likely(places: list[Hypothesis]) -> list[Hypothesis]:
    """The places a picture can have been taken at, the likeliest first; one only where it has no rival."""
    if not places:
        return []
    support, core = places[0].support, max(place.core for place in places)

    def with_share(of_support: float, of_core: float) -> list[Hypothesis]:
        return [p for p in places if p.support >= of_support * support or p.core >= of_core * core]

    if len(with_share(RIVAL_SHARE, RIVAL_CORE_SHARE)) < 2:
        return places[:1]
    return with_share(LISTED_SHARE, LISTED_SHARE)


def is_plain(places: list[Hypothesis], typical: float) -> bool:
    """Whether one place alone is likely, and resembles the picture as much as the place itself would.

    Args:
        places: the likeliest first.
        typical: similarity of neighbours on a driven way, see `typical_similarity`.
    """
    return len(likely(places)) == 1 and places[0].similarity >= PLAIN_FACTOR * typical


def typical_similarity(graph: MapGraph) -> float:
    """Matches of neighbours between which the robot drove, at the median; 0 where it drove nowhere."""
    driven = [edge.inliers for edge in graph.edges.values() if edge.traversals and not edge.suspended]
    return float(statistics.median(driven)) if driven else 0.0
