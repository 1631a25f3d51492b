"""Places where a picture can have been taken: matched nodes grouped by where they put it. Pure.

Nodes of one place agree, by the edges between them, on where the picture was taken; a look-alike elsewhere
speaks for itself and its own neighbours. Without any history nothing else tells them apart.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import Claim
from shared.mapgraph.local.displacement import seen_from
from shared.mapgraph.local.reach import SPOT_M, out_of_reach

COMPARED_NODES = 48
"""Nodes, most alike first, that a goal picture is compared with. With 16 a wrong place of a hostel of twelve
equal rooms had no rival in 1 of 80 pictures; with 24 the right one had but two nodes among them, and was not
named, in 2 of 40, with 48 in none."""
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
