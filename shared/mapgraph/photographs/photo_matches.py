"""A photo's matches with nodes, and the same seen from one of the nodes. Pure."""

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass

import numpy as np

from shared.geometry.photo.plane import focal_of, log_angle, plane_from_lonlat, rays
from shared.geometry.photo.sightings import Sightings
from shared.geometry.sphere import FloatArray, IndexArray, bearings_from_lonlat
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.relative_poses import RelativePose, relative_poses
from shared.messages.features import PhotoView
from shared.messages.matching import NodeMatch

AROUND_M = 2.5
"""Nodes so near to one are reckoned with; chosen: at this distance few matches are left."""
PHOTO_NODES = 60
"""Nodes, most alike first, whose matches are asked for; chosen: more than any ten places of three nodes."""
LOOKING_S = 60.0
"""For how long a question about a photo is asked again while pictures are looked at; chosen: five times what
sixty nodes take on two cores."""
PART_NODES = 40
"""Nodes whose places are solved for together; chosen: those within some three metres."""


@dataclass(frozen=True, eq=False)
class NodeSights:
    """One node's matches: (M, 2) on the photo's plane, its keypoints, (M, 3) bearings in the node's frame."""

    plane: FloatArray
    keypoint: IndexArray
    bearing: FloatArray
    right: FloatArray
    log_size: FloatArray


@dataclass(frozen=True, eq=False)
class PhotoMatches:
    """A photo's matches with nodes.

    Attributes:
        view: what is known of its camera.
        of_node: by node; only those with matches.
    """

    view: PhotoView
    of_node: Mapping[int, NodeSights]

    @property
    def focal(self) -> float:
        """The focal length with which the features were extracted, in halves of the longer side."""
        return focal_of(self.view.fov_rad)

    @property
    def short(self) -> float:
        """The photo's shorter side over its longer one."""
        return min(self.view.aspect, 1.0 / self.view.aspect)


def photo_matches(view: PhotoView, matches: Collection[NodeMatch]) -> PhotoMatches:
    """Read the answer of a match request for a photo; nodes without what it needs are left out."""
    focal, numbers = focal_of(view.fov_rad), dict[tuple[float, float], int]()
    found = {}
    for match in matches:
        if match.matches_rad is None or match.right is None or not len(match.right):
            continue
        rows = match.matches_rad.astype(np.float64)
        plane = plane_from_lonlat(rows[:, :2], focal)
        _, far = rays(plane, focal)
        sizes = np.zeros(len(rows)) if match.log_scale is None else match.log_scale.astype(np.float64)
        keypoint = [numbers.setdefault((lon, lat), len(numbers)) for lon, lat in rows[:, :2].tolist()]
        found[match.node_id] = NodeSights(
            plane,
            np.array(keypoint, dtype=np.intp),
            bearings_from_lonlat(rows[:, 2:]),
            match.right.astype(np.float64),
            sizes - log_angle(focal, far),
        )
    return PhotoMatches(view, found)


@dataclass(frozen=True, eq=False)
class Surroundings:
    """The nodes around a root as the photo's matches need them; `of` (M,) is the node of each match."""

    root: int
    poses: Mapping[int, RelativePose]
    seen: Sightings
    of: IndexArray

    def nearest(self, position_m: FloatArray) -> tuple[int, float]:
        """The node nearest to (3,) a position in the root's frame, and how far it is over the floor."""
        away = {
            node: float(np.linalg.norm(pose.position_m - position_m[:2])) for node, pose in self.poses.items()
        }
        node = min(away, key=lambda each: (away[each], each))
        return node, away[node]


def surroundings(graph: MapGraph, matches: PhotoMatches, root: int) -> Surroundings | None:
    """All matches with nodes around `root`, in its frame; None without any."""
    known = relative_poses(graph, root, graph.nodes, PART_NODES)
    poses = {n: p for n, p in known.items() if float(np.linalg.norm(p.position_m)) < AROUND_M}
    parts = [(pose, matches.of_node[node]) for node, pose in poses.items() if node in matches.of_node]
    of = [np.full(len(matches.of_node[node].right), node) for node in poses if node in matches.of_node]
    if not parts:
        return None
    seen = Sightings(
        plane=np.concatenate([part.plane for _, part in parts]),
        place_m=np.concatenate(
            [np.tile([*pose.position_m, 0.0], (len(part.right), 1)) for pose, part in parts]
        ),
        direction=np.concatenate([part.bearing @ _turn(pose.yaw_rad).T for pose, part in parts]),
        right=np.concatenate([part.right for _, part in parts]),
        log_size=np.concatenate([part.log_size for _, part in parts]),
        keypoint=np.concatenate([part.keypoint for _, part in parts]),
        short=matches.short,
    )
    return Surroundings(root, poses, seen, np.concatenate(of).astype(np.intp))


def _turn(yaw_rad: float) -> FloatArray:
    cos, sin = math.cos(yaw_rad), math.sin(yaw_rad)
    return np.array([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
