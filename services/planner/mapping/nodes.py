"""Making a node and its edges from the current frame (thesis equations 4.1 and 4.2)."""

import math
from collections.abc import Sequence
from typing import Any

from services.planner.echoes import by_sector_m
from services.planner.mapping.edges import NewEdges
from services.planner.mapping.frontiers.floor_gain import covered_m, without_poor_directions
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.ports import MapAccess, Matches, Note, Observation
from services.planner.profiles import Profile
from services.planner.similarity import heading_of, ranked, similarity
from services.planner.surroundings import free_ways_m
from shared.mapgraph.edge_ends import edge_between
from shared.mapgraph.frontiers import with_explored
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.driven_length import driven_length
from shared.mapgraph.local.reach import LOOP_NODES
from shared.messages.maps import AddNode, Edge, Node, Operation, PutEdge, UpdateNode
from shared.messages.matching import NodeMatch

EXPLORED_FACTOR = 1.6
"""Between nodes at most so many times as far apart as a mission has them cover, no floor is left to explore:
as far as s_explored stands for in a room, of which a node covers 1 m. In a bare hall it stands for more."""


def is_new_node(matches: Matches, profile: Profile) -> bool:
    """Node rule 4.2: the nearest node is similar, but not too similar."""
    best = ranked(matches, profile)[:1]
    rules = profile.mapping
    return bool(best) and rules.s_node_max > similarity(best[0][1], profile) > rules.s_edge_min


def add_node(
    maps: MapAccess,
    observation: Observation,
    edges: NewEdges,
    profile: Profile,
    here: Displacement | None,
    views: FloorViews | None = None,
) -> tuple[int, tuple[Note, ...]]:
    """Write the frame as a node with its edges, in one transaction.

    Args:
        maps: where to write.
        observation: the frame and the distances around.
        edges: the edges it gets.
        profile: thresholds.
        here: where the robot is relative to the node it came from, whose edge counts as driven; None where
            nobody knows.
        views: what was seen of the floor so far; gets this view.

    Returns:
        The new node's id, and a note for each edge that was refused.
    """
    node_id = maps.graph.next_id()
    admitted = _driven(edges_to(node_id, edges.admitted, edges, profile), maps.graph, here)
    features, free_m = observation.features, free_ways_m(observation.ranges, profile)
    node = Node(
        node_id=node_id,
        stamp_ns=features.stamp_ns,
        frame_seq=features.seq,
        pipeline=features.pipeline,
        keypoints=len(features.lonlat_rad),
        open=tuple(free >= profile.sensing.opening_m for free in free_m),
        free_m=free_m,
        echoes_m=tuple(round(echo_m, 2) for echo_m in by_sector_m(observation.ranges)),
    )
    seen = admitted + edges_to(node_id, edges.covered, edges, profile)
    node, *others = explored_along(maps.graph, node, seen, profile)
    operations: list[Operation] = [AddNode(node=node, features=features)]
    operations += [PutEdge(edge=edge) for edge in admitted]
    operations += [UpdateNode(node=other) for other in others]
    maps.commit(operations)
    node_id = max(maps.graph.nodes)  # another robot may have taken the id meanwhile: the newest one is this
    views = FloorViews(profile.sensing.robot_slim_m) if views is None else views
    views.add(Displacement(node_id), observation.ranges)
    if poor := without_poor_directions(maps.graph, node_id, profile, views):
        maps.commit([UpdateNode(node=n) for n in poor])
    why = [f"node {node_id}: {reason}" for reason in edges.refused.values()]
    return node_id, tuple(Note("closure_refused", reason) for reason in why)


def explored_along(graph: MapGraph, node: Node, seen: Sequence[Edge], profile: Profile) -> list[Node]:
    """`node`, then each node at the other end of `seen` with less left to explore than before."""
    rules, covers_m = profile.mapping.explored, profile.mapping.covers_m
    longest_m = EXPLORED_FACTOR * covers_m if covers_m else math.inf
    grown = MapGraph([*graph.nodes.values(), node], [*graph.edges.values(), *seen])
    others = [graph.nodes[e.b if e.a == node.node_id else e.a] for e in seen]
    known_m = covered_m(grown, node.node_id, profile) or math.inf
    known = [with_explored(other, grown, rules, longest_m, known_m) for other in others]
    changed = [n for n in known if n != graph.nodes[n.node_id]]
    return [with_explored(node, grown, rules, longest_m, known_m), *changed]


def edges_to(node_id: int, matches: Matches, judged: NewEdges, profile: Profile) -> list[Edge]:
    """Edges from a node, whose frame was matched, to the nodes of `matches`."""
    return [_edge(node_id, n, match, profile, clear=n in judged.clear) for n, match in matches.items()]


def _driven(edges: list[Edge], graph: MapGraph, here: Displacement | None) -> list[Edge]:
    """The edges of a new node with what the robot's way to it says of them."""
    if here is None:
        return edges
    others = {edge.a for edge in edges}
    known = driven_length(graph, here, others, LOOP_NODES)
    learnt: dict[int, dict[str, Any]] = {here.node_id: {"traversals": 1, "why": "driven"}}
    if known is not None:
        length = {"length_m": known.length_m, "length_std_m": known.std_m}
        learnt[known.node_id] = learnt.get(known.node_id, {}) | length
    return [edge.model_copy(update=learnt.get(edge.a, {})) for edge in edges]


def _edge(node_id: int, other: int, match: NodeMatch, profile: Profile, *, clear: bool) -> Edge:
    found = heading_of(match, profile)
    return Edge.model_validate(
        {
            **edge_between(node_id, other, found[0] if found is not None else None, match.yaw_rad),
            "raw_matches": match.raw_matches,
            "inliers": match.inliers,
            "confidence": match.confidence,
            "disparity_rad": match.disparity_rad,
            "s_min": profile.mapping.s_edge_min,
            "s_max": profile.mapping.s_node_max,
            "clear": clear,
            "why": "seen",
        }
    )
