"""Poses of a photo in a map, from rotations that single nodes vote for. Pure."""

import math
from dataclasses import dataclass, field

import numpy as np

from shared.geometry.photo.plane import FOVS_RAD, USUAL_RAD, focal_of, fov_of, rays
from shared.geometry.photo.refine import COARSE_RAD, FINE_RAD, HIGHER_M, focal_spread, refine
from shared.geometry.photo.sightings import PhotoPose, score
from shared.geometry.photo.votes import Vote, vote
from shared.geometry.sphere import FloatArray, wrap_rad
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.relative_poses import relative_poses
from shared.mapgraph.photographs.photo_matches import PART_NODES, PhotoMatches, Surroundings, surroundings

PLACES, ROOTS, FOCALS = 10, 3, 3
"""Places of which poses are sought, nodes of each, and fields of view of a node; chosen: hostels have ten
equal rooms."""
ONE_PLACE_M = 1.5
"""Nodes so near to each other are of one place."""
OFFSETS_M = (0.0, -0.8, 0.8)
"""Starts along the line of sight, which a rotation alone does not tell: nodes stand 0.7 m apart."""
LEFT = 10
"""Coarse poses of a place that are refined finely."""
OFF_THE_MAP_M, NEAR_A_NODE_M = 1.3, 0.6
"""Furthest from any node that a photo is placed, and how far it usually is: floor nearer than a metre to a
node counts as covered."""


@dataclass(frozen=True)
class PhotoPlace:
    """Where a photo was taken.

    Attributes:
        node: the nearest node.
        x_m, y_m: of the photo in the node's camera frame, x ahead, y left; z_m above the node's camera.
        yaw_rad: direction in which it looks, in that frame.
        fov_rad: over its longer side.
        score: evidence, nats.
        keypoints: number of the photo's keypoints that it explains.
        explained: its matches, node and number of the keypoint.
    """

    node: int
    x_m: float
    y_m: float
    z_m: float
    yaw_rad: float
    fov_rad: float
    score: float
    keypoints: int
    explained: frozenset[tuple[int, int]] = field(default=frozenset(), repr=False, compare=False)


@dataclass(frozen=True, eq=False)
class _Start:
    root: int
    focal: float
    vote: Vote


def poses_of(graph: MapGraph, matches: PhotoMatches, rng: np.random.Generator) -> list[PhotoPlace]:
    """Poses that explain the matches, the likeliest first: several of each place.

    Args:
        graph: the map.
        matches: of the photo with its nodes.
        rng: draws the votes' pairs.
    """
    found = []
    for starts in _places(graph, _starts(graph, matches, rng)):
        coarse = []
        for root in dict.fromkeys(start.root for start in starts):
            around = surroundings(graph, matches, root)
            if around is not None:
                own = [start for start in starts if start.root == root]
                coarse += [_coarse(around, matches, start, off) for start in own for off in OFFSETS_M]
        coarse.sort(key=lambda each: -each[0])
        found += [_fine(matches, around, pose) for _, around, pose in coarse[:LEFT]]
    kept = [place for place in found if place is not None]
    return sorted(kept, key=lambda place: -place.score)


def _starts(graph: MapGraph, matches: PhotoMatches, rng: np.random.Generator) -> list[_Start]:
    """Votes of all nodes, the heaviest first."""
    view = matches.view
    focals = [matches.focal] if view.fov_known else [focal_of(fov_rad) for fov_rad in FOVS_RAD]
    found = []
    for node, sights in matches.of_node.items():
        if node not in graph.nodes:
            continue
        for focal in focals:
            bearing, _ = rays(sights.plane, focal)
            heard = vote(bearing, sights.bearing, sights.right, rng)
            if heard is not None:
                found.append(_Start(node, focal, heard))
    return sorted(found, key=lambda start: (-start.vote.weight, start.root))


def _places(graph: MapGraph, starts: list[_Start]) -> list[list[_Start]]:
    """Starts by place: at most ROOTS nodes each, and FOCALS fields of view of a node."""
    places: list[list[_Start]] = []
    near: list[set[int]] = []
    for start in starts:
        of = next((k for k, nodes in enumerate(near) if start.root in nodes), None)
        if of is None:
            if len(places) == PLACES:
                continue
            poses = relative_poses(graph, start.root, graph.nodes, PART_NODES)
            inside = {n for n, p in poses.items() if float(np.linalg.norm(p.position_m)) < ONE_PLACE_M}
            near.append(inside)
            places.append([start])
            continue
        roots = [each.root for each in places[of]]
        if roots.count(start.root) < FOCALS and (start.root in roots or len(set(roots)) < ROOTS):
            places[of].append(start)
    return places


def _coarse(
    around: Surroundings, matches: PhotoMatches, start: _Start, off_m: float
) -> tuple[float, Surroundings, PhotoPose]:
    ahead = start.vote.rotation[:, 0] * np.array([1.0, 1.0, 0.0])
    at = off_m * ahead / max(float(np.linalg.norm(ahead)), 1e-9)
    begun = PhotoPose(start.vote.rotation, at, math.log(start.focal))
    pose = refine(around.seen, begun, COARSE_RAD, _usual(matches), focal_known=matches.view.fov_known)
    return score(around.seen, pose)[0], around, pose


def _fine(matches: PhotoMatches, around: Surroundings, coarse: PhotoPose) -> PhotoPlace | None:
    pose = refine(around.seen, coarse, FINE_RAD, _usual(matches), focal_known=matches.view.fov_known)
    node, off_m = around.nearest(pose.position_m)
    if off_m > OFF_THE_MAP_M:
        return None
    nats, explained = score(around.seen, pose)
    keypoints = around.seen.keypoint[explained]
    matches_of = frozenset(zip(around.of[explained].tolist(), keypoints.tolist(), strict=True))
    focal_off = (pose.log_focal - _usual(matches)) / focal_spread(matches.view.fov_known)
    nats -= 0.5 * ((off_m / NEAR_A_NODE_M) ** 2 + (pose.position_m[2] / HIGHER_M) ** 2 + focal_off**2)
    of = around.poses[node]
    x_m, y_m = _turned(pose.position_m[:2] - of.position_m, -of.yaw_rad)
    ahead = pose.rotation[:, 0]
    yaw_rad = float(wrap_rad(math.atan2(ahead[1], ahead[0]) - of.yaw_rad))
    fov_rad = fov_of(math.exp(pose.log_focal))
    seen = len(np.unique(keypoints))
    return PhotoPlace(
        node, x_m, y_m, float(pose.position_m[2]), yaw_rad, fov_rad, float(nats), seen, matches_of
    )


def _usual(matches: PhotoMatches) -> float:
    """About what ln f is."""
    return math.log(matches.focal if matches.view.fov_known else focal_of(USUAL_RAD))


def _turned(xy: FloatArray, angle_rad: float) -> tuple[float, float]:
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return float(cos * xy[0] - sin * xy[1]), float(sin * xy[0] + cos * xy[1])
