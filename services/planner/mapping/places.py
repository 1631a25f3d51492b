"""Making a place and its edges from the current frame (thesis equations 4.1 and 4.2)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from services.planner.closures import contradicted, unsupported_closures, witnessed
from services.planner.frontiers import with_explored
from services.planner.graph import MapGraph, edge_between
from services.planner.mapping.rivals import has_rival
from services.planner.mapping.surroundings import is_clear_from, is_surely_clear, openings
from services.planner.ports import MapAccess, Note, Observation
from services.planner.profiles import Profile
from services.planner.similarity import heading_of, ranked, similarity, trusted
from shared.messages.maps import AddNode, Edge, Node, Operation, PutEdge, UpdateNode
from shared.messages.matching import NodeMatch

CONFIDENCE_MIN = 0.5
"""Of the two-view geometry of an edge: below it its two directions are too alike to tell."""


def is_new_place(matches: dict[int, NodeMatch], profile: Profile) -> bool:
    """Node rule 4.2: the nearest place is similar, but not too similar."""
    best = ranked(matches, profile)[:1]
    return bool(best) and profile.s_node_max > similarity(best[0][1], profile) > profile.s_edge_min


@dataclass(frozen=True)
class Edges:
    """The places that a new frame resembles: those that get an edge, and why the others do not.

    Attributes:
        clear: those with free ground seen all the way.
        covered: too uncertain for an edge, but there: nothing is unexplored that way.
    """

    admitted: dict[int, NodeMatch] = field(default_factory=dict)
    clear: frozenset[int] = frozenset()
    refused: dict[int, str] = field(default_factory=dict)
    covered: dict[int, NodeMatch] = field(default_factory=dict)


def judge_edges(
    graph: MapGraph,
    observation: Observation,
    matches: dict[int, NodeMatch],
    profile: Profile,
    driven_from: int | None,
) -> Edges:
    """Which edges a new place gets.

    Args:
        graph: the map without the new place.
        observation: the frame and the distances around.
        matches: the frame against the places of the map.
        profile: thresholds.
        driven_from: node the robot came from.
    """
    similar = {n: m for n, m in matches.items() if n in graph.nodes and _admitted(m, profile)}
    clear = frozenset(
        n
        for n, m in similar.items()
        if is_surely_clear(m, observation.ranges, profile) or is_clear_from(graph.nodes[n], m, profile)
    )
    enough = {
        n: m
        for n, m in similar.items()
        if n == driven_from
        or (
            not _far(m, profile)
            and (n in clear or _enough_for_blind(m, profile))
            and _enough_agree(m, profile)
        )
    }
    refused = _refused(graph, enough, profile, driven_from)
    admitted = {n: m for n, m in enough.items() if n not in refused}
    covered = {n: similar[n] for n in witnessed(graph, similar, set(admitted))}
    return Edges(admitted, clear, refused, covered)


def add_place(
    maps: MapAccess,
    observation: Observation,
    edges_of: Edges,
    profile: Profile,
    driven_from: int | None,
) -> tuple[int, tuple[Note, ...]]:
    """Write the frame as a node with its edges, in one transaction.

    Args:
        maps: where to write.
        observation: the frame and the distances around.
        edges_of: the edges it gets.
        profile: thresholds.
        driven_from: node the robot came from; its edge counts as driven.

    Returns:
        The new node's id, and a note for each edge that was refused.
    """
    node_id = maps.graph.next_id()
    edges = edges_to(node_id, edges_of.admitted, edges_of, profile, driven_from)
    features = observation.features
    node = Node(
        node_id=node_id,
        stamp_ns=features.stamp_ns,
        frame_seq=features.seq,
        pipeline=features.pipeline,
        keypoints=len(features.lonlat_rad),
        open=openings(observation.ranges, profile),
    )
    seen = edges + edges_to(node_id, edges_of.covered, edges_of, profile)
    node, *others = explored_along(maps.graph, node, seen, profile)
    operations: list[Operation] = [AddNode(node=node, features=features)]
    operations += [PutEdge(edge=edge) for edge in edges]
    operations += [UpdateNode(node=other) for other in others]
    maps.commit(operations)
    node_id = max(maps.graph.nodes)  # another robot may have taken the id meanwhile: the newest one is this
    return node_id, tuple(
        Note("closure_refused", f"node {node_id}: {why}") for why in edges_of.refused.values()
    )


def explored_along(graph: MapGraph, node: Node, seen: Sequence[Edge], profile: Profile) -> list[Node]:
    """`node`, then each place at the other end of `seen` with less left to explore than before."""
    grown = MapGraph([*graph.nodes.values(), node], [*graph.edges.values(), *seen])
    others = [graph.nodes[e.b if e.a == node.node_id else e.a] for e in seen]
    known = [with_explored(other, grown, profile) for other in others]
    changed = [n for n in known if n != graph.nodes[n.node_id]]
    return [with_explored(node, grown, profile), *changed]


def edges_to(
    node_id: int,
    places: Mapping[int, NodeMatch],
    judged: Edges,
    profile: Profile,
    driven_from: int | None = None,
) -> list[Edge]:
    """Edges from a node, whose frame was matched, to `places`."""
    return [
        _edge(node_id, other, match, profile, clear=other in judged.clear, driven=other == driven_from)
        for other, match in places.items()
    ]


def _refused(
    graph: MapGraph, admitted: dict[int, NodeMatch], profile: Profile, driven_from: int | None
) -> dict[int, str]:
    """Edges that are ambiguous, without a witness or outvoted; raw similarity asks for none of it.

    The view of the place the robot came from was followed frame by frame, so it is not ambiguous.
    """
    if profile.similarity == "raw":
        return {}
    why = "two motions explain the view of node"
    refused = {n: f"{why} {n}" for n, m in admitted.items() if n != driven_from and has_rival(m)}
    left = {n: m for n, m in admitted.items() if n not in refused}
    refused |= unsupported_closures(graph, left, driven_from, profile.s_far)
    left = {n: m for n, m in admitted.items() if n not in refused}
    return refused | contradicted(graph, left, admitted)


def _admitted(match: NodeMatch, profile: Profile) -> bool:
    """Edge rule 4.1; verified similarity also asks for trusted geometry that is sure of its direction."""
    if similarity(match, profile) <= profile.s_edge_min:
        return False
    if profile.similarity == "raw":
        return True
    return trusted(match, profile) and match.heading_rad is not None and match.confidence >= CONFIDENCE_MIN


def _enough_agree(match: NodeMatch, profile: Profile) -> bool:
    """Whether so many of the raw matches are verified that a look-alike place is no explanation."""
    sure = similarity(match, profile) >= profile.s_sure
    return sure or match.inliers >= profile.share_min * match.raw_matches


def _enough_for_blind(match: NodeMatch, profile: Profile) -> bool:
    """Whether a place is so surely there that an edge needs no free ground seen.

    Of 238 such edges of three explorations of a village two had a smaller share than 0.5; one was wrong.
    """
    share = match.inliers / max(match.raw_matches, 1)
    return similarity(match, profile) >= profile.s_blind_min and share >= profile.share_min


def _far(match: NodeMatch, profile: Profile) -> bool:
    """Whether only things far away agree, so that the place may be anywhere along the way."""
    disparity_rad = match.disparity_rad if match.disparity_rad is not None else 0.0
    return disparity_rad < profile.far_rad and similarity(match, profile) < profile.s_sure


def _edge(node_id: int, other: int, match: NodeMatch, profile: Profile, *, clear: bool, driven: bool) -> Edge:
    found = heading_of(match, profile)
    return Edge.model_validate(
        {
            **edge_between(node_id, other, found[0] if found is not None else None, match.yaw_rad),
            "raw_matches": match.raw_matches,
            "inliers": match.inliers,
            "confidence": match.confidence,
            "disparity_rad": match.disparity_rad,
            "s_min": profile.s_edge_min,
            "s_max": profile.s_node_max,
            "clear": clear,
            "traversals": int(driven),
            "why": "driven" if driven else "seen",
        }
    )
