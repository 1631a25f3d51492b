"""Which of the places that a picture resembles it can have been taken at. Pure.

Where nodes stand nearer to the spot, more of them match: that makes no place likelier than its twin. So once
there are rivals each is asked how much the picture would resemble it, had it been taken there. Bearings say
where that is, which count no matches, and from there

    expected = sum over the nearest nodes of S(0) / (1 + d / h),

the law by which matches are lost with distance (view_range). A twin 0.1 m from a node was expected to have
twice the matches of the right place 0.6 m from one, and had half as many again.
"""

import math
import statistics
from collections.abc import Mapping, Sequence

from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.claims import Claim
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.hypotheses import CORE_NODES, NEAR_NODES, Hypothesis
from shared.mapgraph.local.relative_poses import relative_poses
from shared.mapgraph.local.resection import bearing_miss_rad, resected
from shared.mapgraph.local.view_range import similarity_at

RIVAL_SHARE, RIVAL_CORE_SHARE = 0.5, 0.6
"""Another place with this share of the likeliest one's support, or of the greatest core, may be it as well.
Of 420 pictures taken anywhere in two maps of a hostel of equal rooms and one of an office of equal desks none
without such a rival was put at a wrong place; by 0.6 of the support alone two of 207 were, and a goal of a
round by half of it: in a room where a node stood nearer."""
LISTED_SHARE = 0.45
"""Places down to this share are named, once there is a rival: the right one was among them in all of the
others, by support or by the core; at 0.5 in all but one."""
FIT_SHARE = 0.6
"""Of them one that has less of its expected matches than this share of what another has is none: of 290
pictures of a hostel and an office the right place had 0.68 at the least. More than are expected make none
likelier: clouds over a yard agree with nodes of all of it, and outdid the right place, with 0.8 of what was
expected there, in 6 of 120 pictures of two yards."""
SHOWS_FACTOR = 2.0
"""A place whose core has this many times the matches that show another from near is one, too: in a street
with furniture moved 23 matches with one node did, 28 m off, and none of the right place's 119; chosen."""
CROSSING_RAD = math.radians(6.0)
"""Bearings of a place that miss its nodes by more than this, at the median, cross nowhere: far off in a yard
all nodes of one corner see the picture the same way. Of 432 right places in eight worlds the worst missed by
4.9 degrees; of 19 wrong ones more than 8 m off, outdoors, the median is 9."""
PLAIN_FACTOR = 1.2
"""A place alone is plain where its best node has this many times the matches of neighbours on a driven way.
Of 137 pictures whose place had no rival 130 have; of 160 without their place in the map 5 have."""


def likely(graph: MapGraph, claims: Mapping[int, Claim], places: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The places a picture can have been taken at, the likeliest first; one only where it has no rival.

    A place of which nothing near shows, or whose bearings cross nowhere, is none while there is another; the
    first only where it does not have far more matches.

    Args:
        graph: the map.
        claims: what the picture says of nodes of it.
        places: what they speak for, that with most support first.
    """
    shown = _shown(claims, places)
    spots = {place: _spot(graph, claims, place) for place in shown}
    rivals = _rivals([place for place in shown if _crosses(graph, claims, place, spots[place])] or shown)
    if len(rivals) < 2:
        return rivals
    fits = [_fit(graph, claims, place, spots[place]) for place in rivals]
    least = FIT_SHARE * min(1.0, max((fit for fit in fits if fit is not None), default=0.0))
    return [place for place, fit in zip(rivals, fits, strict=True) if fit is None or fit >= least]


def is_plain(found: Sequence[Hypothesis], typical: float) -> bool:
    """Whether one place alone is likely, and resembles the picture as much as the place itself would.

    Args:
        found: the likely places.
        typical: similarity of neighbours on a driven way, see `typical_similarity`.
    """
    return len(found) == 1 and found[0].similarity >= PLAIN_FACTOR * typical


def typical_similarity(graph: MapGraph) -> float:
    """Matches of neighbours between which the robot drove, at the median; 0 where it drove nowhere."""
    driven = [edge.inliers for edge in graph.edges.values() if edge.traversals and not edge.suspended]
    return float(statistics.median(driven)) if driven else 0.0


def _rivals(places: Sequence[Hypothesis]) -> list[Hypothesis]:
    """The places with a fair share of the matches that the best one has."""
    if not places:
        return []
    support, core = places[0].support, max(place.core for place in places)

    def with_share(of_support: float, of_core: float) -> list[Hypothesis]:
        return [p for p in places if p.support >= of_support * support or p.core >= of_core * core]

    if len(with_share(RIVAL_SHARE, RIVAL_CORE_SHARE)) < 2:
        return [places[0]]
    return with_share(LISTED_SHARE, LISTED_SHARE)


def _shown(claims: Mapping[int, Claim], places: Sequence[Hypothesis]) -> list[Hypothesis]:
    """Places of which something near shows, and those with far more matches than show that of any."""
    near = {place: [claims[node] for node in place.nodes if claims[node].is_near] for place in places}
    cores = [sum(claim.similarity for claim in seen[:CORE_NODES]) for seen in near.values()]
    least = SHOWS_FACTOR * max(cores, default=0)
    return [place for place in places if near[place] or place.core >= least]


def _spot(graph: MapGraph, claims: Mapping[int, Claim], place: Hypothesis) -> Displacement | None:
    """Where the nodes of a place put the picture; None where no bearings say it."""
    return resected(graph, {node: claims[node] for node in place.nodes}, place.nodes[0], NEAR_NODES)


def _crosses(
    graph: MapGraph, claims: Mapping[int, Claim], place: Hypothesis, at: Displacement | None
) -> bool:
    """Whether the bearings of a place cross at the spot where they put the picture, or say nothing of it."""
    if at is None:
        return True
    miss_rad = bearing_miss_rad(graph, {node: claims[node] for node in place.nodes}, at, NEAR_NODES)
    return miss_rad is None or miss_rad < CROSSING_RAD


def _fit(
    graph: MapGraph, claims: Mapping[int, Claim], place: Hypothesis, at: Displacement | None
) -> float | None:
    """Matches of a place as a share of those expected of it; None where no bearings say where it is.

    Nodes were left out of the comparison as others were more alike: each may have as many matches as the
    least of those has.
    """
    if at is None:
        return None
    root = place.nodes[0]
    poses = relative_poses(graph, root, graph.nearest(root, NEAR_NODES), NEAR_NODES)
    away_m = {node: math.dist(pose.position_m, (at.x_m, at.y_m)) for node, pose in poses.items()}
    around = sorted(away_m, key=lambda node: (away_m[node], node))[:CORE_NODES]
    unknown = max(CORE_NODES - len(place.nodes), 0) * min(claim.similarity for claim in claims.values())
    return (place.core + unknown) / sum(similarity_at(graph, node, away_m[node]) for node in around)
