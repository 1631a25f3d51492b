"""A map as a scene of Foxglove: nodes where their bearings and driven lengths put them. Needs `foxglove`."""

import time

from foxglove.messages import (
    Color,
    LinePrimitive,
    LinePrimitiveLineType,
    Point3,
    Pose,
    SceneEntity,
    SceneUpdate,
    SpherePrimitive,
    TextPrimitive,
    Timestamp,
    Vector3,
)

from services.recorder.foxglove.drawings import rotation
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.relative_poses import RelativePose, relative_poses
from shared.messages.maps import Edge

MOST_NODES = 500
"""Nodes drawn, those nearest to the first one; they are placed in less than a second."""
NODE_M = 0.15  # diameter, seen beside the robot of 0.5 m
LINE_PX = 2.0
TEXT_PX = 14.0
NODE_COLOR = Color(r=0.2, g=0.4, b=1.0, a=1.0)
EDGE_COLOR = Color(r=0.5, g=0.5, b=0.5, a=1.0)
SUSPENDED_COLOR = Color(r=0.9, g=0.2, b=0.2, a=1.0)
PLACE_COLOR = Color(r=1.0, g=0.5, b=0.0, a=1.0)

Poses = dict[int, RelativePose]


def map_scene(name: str, graph: MapGraph) -> SceneUpdate:
    """The part of a map that edges join to its first node, in a frame of its own: "map flat".

    The first node is the origin and looks along x. A map without a node is an empty scene.

    Args:
        name: of the map.
        graph: its nodes, edges and places.
    """
    root = min(graph.nodes, default=None)
    poses = {} if root is None else relative_poses(graph, root, graph.nodes, MOST_NODES)
    now_ns = time.time_ns()
    entity = SceneEntity(
        timestamp=Timestamp(now_ns // 10**9, now_ns % 10**9),
        frame_id=f"map {name}",
        id=f"map {name}",
        spheres=[SpherePrimitive(pose=_at(poses[n]), size=_cube(NODE_M), color=NODE_COLOR) for n in poses],
        lines=[_lines(graph, poses, suspended=False), _lines(graph, poses, suspended=True)],
        texts=_texts(graph, poses),
    )
    return SceneUpdate(entities=[entity])


def _at(pose: RelativePose, up_m: float = 0.0) -> Pose:
    x_m, y_m = map(float, pose.position_m)
    return Pose(position=Vector3(x=x_m, y=y_m, z=up_m), orientation=rotation(pose.yaw_rad))


def _cube(side_m: float) -> Vector3:
    return Vector3(x=side_m, y=side_m, z=side_m)


def _lines(graph: MapGraph, poses: Poses, *, suspended: bool) -> LinePrimitive:
    drawn = [edge for edge in graph.edges.values() if edge.suspended == suspended and _both(edge, poses)]
    ends = [poses[node].position_m for edge in drawn for node in (edge.a, edge.b)]
    return LinePrimitive(
        type=LinePrimitiveLineType.LineList,
        thickness=LINE_PX,
        scale_invariant=True,
        points=[Point3(x=float(x_m), y=float(y_m), z=0.0) for x_m, y_m in ends],
        color=SUSPENDED_COLOR if suspended else EDGE_COLOR,
    )


def _both(edge: Edge, poses: Poses) -> bool:
    return edge.a in poses and edge.b in poses


def _texts(graph: MapGraph, poses: Poses) -> list[TextPrimitive]:
    """The number of each node, and the names of places above the node that one drives to."""
    said = [(_at(poses[node], NODE_M), str(node), NODE_COLOR) for node in poses]
    said += [
        (_at(poses[place.nodes[0]], 2 * NODE_M), place.name, PLACE_COLOR)
        for place in graph.places.values()
        if place.nodes and place.nodes[0] in poses
    ]
    return [
        TextPrimitive(
            pose=pose, billboard=True, font_size=TEXT_PX, scale_invariant=True, color=color, text=text
        )
        for pose, text, color in said
    ]
