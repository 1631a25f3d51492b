"""What poses of a photo amount to: found, one of several places that look alike, or not found. Pure."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from shared.geometry.sphere import FloatArray
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.relative_poses import relative_poses
from shared.mapgraph.photographs.photo_matches import PART_NODES, PhotoMatches
from shared.mapgraph.photographs.search import PhotoPlace, poses_of
from shared.messages.features import PhotoView

# Chosen by `topnav study phone-photos` in the apartment, RIVAL_SHARE in the hostel, whose rooms are equal.
LEAST_NATS, LEAST_KEYPOINTS, LEAST_EACH = 30.0, 8, 1.2
"""Evidence, keypoints that are explained, and evidence of each, below which nothing is claimed: blank walls
and floors give so little, and chance explains many keypoints poorly. Of 95 photos of the apartment what would
be named wrongly for want of evidence has 6 or 7 keypoints and up to 39 nats, what is right 10 and 34."""
RIVAL_SHARE = 0.5
"""A place elsewhere with this share of the evidence may be it as well: rooms furnished alike reach it."""
LISTED_SHARE = 0.45
"""Places down to this share are named, once there is a rival."""
ONE_PLACE_M, ONE_PLACE_RAD = 2.5, float(np.deg2rad(45.0))
"""Poses so near to each other are one place: where in it, their spread tells."""
SAME_SIGHT = 0.5
"""So are poses that share this part of the matches of the one that explains fewer: they see the same things,
from nearer by with a wider view perhaps, where look-alikes see others."""
NATS_APART = 4.0
"""Evidence by which a pose is e times likelier: matches are not independent and count for less."""
SURE_M = 0.7
"""Spread of the poses of a place above which it is not said where in it."""
EQUAL_M = 0.15
"""Poses so near to each other are one pose, reached from two starts."""
MOST_PLACES = 8
"""Places named; chosen: as many as people can look at."""

PhotoVerdict = Literal["found", "ambiguous", "weak", "not_found"]


@dataclass(frozen=True)
class PhotoAnswer:
    """Where a photo was taken.

    Attributes:
        verdict: `found` at one place; `ambiguous`: at one of several that look alike; `weak`: about there,
            where within some metres is not clear; `not_found`: the map explains too little of it.
        places: the likeliest first; empty where it is not found.
        fov_rad: of the likeliest pose, however little speaks for it; None without any.
        score: its evidence, nats.
    """

    verdict: PhotoVerdict
    places: tuple[PhotoPlace, ...]
    fov_rad: float | None = None
    score: float = -math.inf

    def looked_again(self, view: PhotoView) -> PhotoView | None:
        """The view with which to extract its features once more, nearer to the truth; None where it is known.

        Drawn with another field of view than its own a photo is distorted: with the found one more matches,
        where it was found rightly. Of both answers the one with more evidence counts.
        """
        if view.fov_known or self.fov_rad is None:
            return None
        return view.model_copy(update={"fov_rad": self.fov_rad})


@dataclass(frozen=True)
class _Near:
    """A pose in the frame of another one's node: (2,) position, and yaw beside that of the other."""

    place: PhotoPlace
    position_m: FloatArray
    yaw_rad: float


def located(graph: MapGraph, matches: PhotoMatches, rng: np.random.Generator) -> PhotoAnswer:
    """Where a photo was taken, by its matches with nodes of the map."""
    return judged(graph, poses_of(graph, matches, rng))


def judged(graph: MapGraph, poses: Sequence[PhotoPlace]) -> PhotoAnswer:
    """The same from poses, the likeliest first."""
    if not poses:
        return PhotoAnswer("not_found", ())
    fov_rad, score = poses[0].fov_rad, poses[0].score
    if not _is_claim(poses[0]):
        return PhotoAnswer("not_found", (), fov_rad, score)
    left, floor = list(poses), LISTED_SHARE * poses[0].score
    places: list[PhotoPlace] = []
    spreads_m: list[float] = []
    while left and left[0].score >= floor and len(places) < MOST_PLACES:
        near, left = _split(graph, left)
        place, spread_m = _middle(graph, near)
        places.append(place)
        spreads_m.append(spread_m)
    if len(places) > 1 and places[1].score >= RIVAL_SHARE * places[0].score:
        return PhotoAnswer("ambiguous", tuple(places), fov_rad, score)
    return PhotoAnswer("found" if spreads_m[0] <= SURE_M else "weak", tuple(places[:1]), fov_rad, score)


def _is_claim(pose: PhotoPlace) -> bool:
    least = max(LEAST_NATS, LEAST_EACH * pose.keypoints)
    return pose.score >= least and pose.keypoints >= LEAST_KEYPOINTS


def _split(graph: MapGraph, poses: Sequence[PhotoPlace]) -> tuple[list[_Near], list[PhotoPlace]]:
    """Those of the first one's place, and the others."""
    first = poses[0]
    around = relative_poses(graph, first.node, {pose.node for pose in poses}, PART_NODES)
    here, near, others = np.array([first.x_m, first.y_m]), [], []
    for pose in poses:
        of = around.get(pose.node)
        if of is None:
            others.append(pose)
            continue
        cos, sin = math.cos(of.yaw_rad), math.sin(of.yaw_rad)
        at = of.position_m + np.array([[cos, -sin], [sin, cos]]) @ np.array([pose.x_m, pose.y_m])
        turned_rad = math.remainder(pose.yaw_rad + of.yaw_rad - first.yaw_rad, math.tau)
        beside = float(np.linalg.norm(at - here)) < ONE_PLACE_M and abs(turned_rad) < ONE_PLACE_RAD
        if beside or _same_sight(first, pose):
            near.append(_Near(pose, at, turned_rad))
        else:
            others.append(pose)
    return near, others


def _same_sight(first: PhotoPlace, other: PhotoPlace) -> bool:
    fewer = min(len(first.explained), len(other.explained))
    return fewer > 0 and len(first.explained & other.explained) >= SAME_SIGHT * fewer


def _middle(graph: MapGraph, near: Sequence[_Near]) -> tuple[PhotoPlace, float]:
    """The mean of a place's poses by how likely they are, and their spread, metres."""
    different: list[_Near] = []
    for one in near:
        if all(float(np.linalg.norm(one.position_m - other.position_m)) > EQUAL_M for other in different):
            different.append(one)
    best = different[0].place
    weight = np.exp([(one.place.score - best.score) / NATS_APART for one in different])
    weight /= weight.sum()
    at = np.array([one.position_m for one in different])
    middle = weight @ at
    spread_m = math.sqrt(float(weight @ ((at - middle) ** 2).sum(axis=1)))
    yaw_rad = best.yaw_rad + float(weight @ np.array([one.yaw_rad for one in different]))
    return _as_of_nearest(
        graph, replace(best, x_m=float(middle[0]), y_m=float(middle[1]), yaw_rad=yaw_rad)
    ), spread_m


def _as_of_nearest(graph: MapGraph, place: PhotoPlace) -> PhotoPlace:
    """The same place, told of the node nearest to it."""
    around = relative_poses(graph, place.node, graph.nodes, PART_NODES)
    at = np.array([place.x_m, place.y_m])
    node = min(around, key=lambda each: (float(np.linalg.norm(around[each].position_m - at)), each))
    of = around[node]
    cos, sin = math.cos(of.yaw_rad), math.sin(of.yaw_rad)
    x_m, y_m = np.array([[cos, sin], [-sin, cos]]) @ (at - of.position_m)
    yaw_rad = math.remainder(place.yaw_rad - of.yaw_rad, math.tau)
    return replace(place, node=node, x_m=float(x_m), y_m=float(y_m), yaw_rad=yaw_rad)
