"""Standing at a node again: the map has grown around it, and much that was unexplored no longer is."""

import math

from services.planner.mapping.edges import judge_edges
from services.planner.mapping.nodes import edges_to, explored_along
from services.planner.ports import MapAccess, Matches, Note, Observation
from services.planner.profiles import Profile
from shared.mapgraph.frontiers import frontier_sectors
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import Edge, UpdateNode


def close_known_directions(
    maps: MapAccess,
    observation: Observation,
    matches: Matches,
    profile: Profile,
    here: Displacement,
) -> tuple[Note, ...]:
    """Mark the directions of a node explored in which nodes added since are in sight.

    No edges are made: the robot stands only about where the node is.

    Args:
        maps: what is known, and where to write.
        observation: the frame and the distances around.
        matches: the frame against the nodes most like it.
        profile: thresholds.
        here: where the robot is relative to the node.

    Returns:
        A note when directions were closed.
    """
    graph, node_id, yaw_rad = maps.graph, here.node_id, -here.yaw_rad
    node = graph.nodes[node_id]
    others = {n: m for n, m in matches.items() if n != node_id}
    judged = judge_edges(graph, observation, others, profile, here)
    new = {n: m for n, m in (judged.admitted | judged.covered).items() if graph.edge(node_id, n) is None}
    seen = [_turned(edge, node_id, yaw_rad) for edge in edges_to(node_id, new, judged, profile)]
    looked, *changed = explored_along(graph, node, seen, profile)
    closed = len(frontier_sectors(node)) - len(frontier_sectors(looked))
    if looked != node:
        changed.append(looked)
    if changed:
        maps.commit([UpdateNode(node=n) for n in changed])
    return (
        (Note("directions_seen", f"node {node_id}: {closed} directions lead to known nodes"),)
        if closed
        else ()
    )


def _turned(edge: Edge, node_id: int, yaw_rad: float) -> Edge:
    """The edge as from the node's camera instead of from the robot's."""
    heading, sign = ("heading_ab_rad", -1.0) if edge.a == node_id else ("heading_ba_rad", 1.0)
    turns = {heading: -yaw_rad, "yaw_ab_rad": sign * yaw_rad}
    angles = {name: getattr(edge, name) for name in turns}
    update = {n: math.remainder(a + turns[n], math.tau) for n, a in angles.items() if a is not None}
    return edge.model_copy(update=update)
