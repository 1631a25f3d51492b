"""What a photo and panoramas around both show, against poses of the photo. Pure.

Panoramas stand at known places p of one frame. A match says: what the panorama at p sees in direction d, the
photo shows at a point of its plane. At distance r the thing is at p + r d, and from x it is seen along
r d - (x - p): for r between near and far an arc from d towards p - x. A photo taken beside the panorama has
short arcs, which foretell both coordinates; one taken further off has long ones, which foretell little. That
is told by densities: a right match lies on its arc within the noise, even along it, a wrong one anywhere in
the photo. Where it lies on the arc says r, and with it how much larger the thing is in the photo.
"""

from dataclasses import dataclass

import numpy as np

from shared.geometry.photo.plane import area_sr, log_angle, rays
from shared.geometry.sphere import BoolArray, FloatArray, IndexArray
from shared.geometry.tilted.match_evidence import CHANCE_SCALE, TAIL_SHARE, TAIL_WIDTH

NEAR_M, FAR_M = 0.6, 30.0
"""Nearest and furthest things; chosen: the robot comes no nearer to what it can recognise, and further off
nothing moves."""
NOISE_RAD = float(np.deg2rad(0.3))
"""Spread of right matches about their arcs: 0.2 degrees measured at true poses, the rest for the places."""
SCALE_NOISE = 0.14
"""Spread of ln(size ratio): 0.11 measured at true poses; keypoints of wide photos are drawn out."""
TINY_M = 1e-6
"""Keeps a direction from a place to itself finite."""


@dataclass(frozen=True, eq=False)
class Sightings:
    """Matches of one photo with panoramas of one frame.

    Attributes:
        plane: (M, 2) where in the photo.
        place_m: (M, 3) where the panorama stands.
        direction: (M, 3) unit bearing from there.
        right: (M,) probability that the match is right, by its descriptors.
        log_size: (M,) ln of the size on the photo's plane over that in the panorama, radians.
        keypoint: (M,) number of the photo's keypoint.
        short: the photo's shorter side over its longer one.
    """

    plane: FloatArray
    place_m: FloatArray
    direction: FloatArray
    right: FloatArray
    log_size: FloatArray
    keypoint: IndexArray
    short: float

    def __len__(self) -> int:
        return len(self.right)


@dataclass(frozen=True, eq=False)
class PhotoPose:
    """Where a photo was taken: rotation (3, 3) to the frame, position (3,), ln of the focal length."""

    rotation: FloatArray
    position_m: FloatArray
    log_focal: float


@dataclass(frozen=True, eq=False)
class Misses:
    """A pose against M matches.

    Attributes:
        across_rad: off the plane of the arc; beyond_rad: beyond its ends.
        log_scale: ln of the size ratio less what the pose foretells.
        arc_rad: length of the arc.
        area_sr: solid angle that the photo shows: a wrong match lies anywhere in it. A narrow view has small
            errors, and small chances.
    """

    across_rad: FloatArray
    beyond_rad: FloatArray
    log_scale: FloatArray
    arc_rad: FloatArray
    area_sr: float


def misses(seen: Sightings, pose: PhotoPose) -> Misses:
    """How far each match is from what a pose foretells."""
    focal = float(np.exp(pose.log_focal))
    ray, far = rays(seen.plane, focal)
    ray = ray @ pose.rotation.T
    ahead = seen.direction
    back = seen.place_m - pose.position_m
    along_m = np.sum(back * ahead, axis=1)
    aside = back - along_m[:, None] * ahead
    aside_m = np.linalg.norm(aside, axis=1)
    aside = aside / np.maximum(aside_m, TINY_M)[:, None]
    angle = np.arctan2(np.sum(ray * aside, axis=1), np.sum(ray * ahead, axis=1))
    least, most = np.arctan2(aside_m, FAR_M + along_m), np.arctan2(aside_m, NEAR_M + np.maximum(along_m, 0.0))
    most = np.maximum(most, least)  # a thing ahead of the panorama and of the photo
    on_arc = np.clip(angle, least, most)
    from_place_m = np.clip(aside_m / np.tan(np.maximum(on_arc, 1e-4)) - along_m, NEAR_M, FAR_M)
    from_photo_m = np.hypot(from_place_m + along_m, aside_m)
    return Misses(
        np.arcsin(np.clip(np.sum(ray * np.cross(ahead, aside), axis=1), -1.0, 1.0)),
        angle - on_arc,
        seen.log_size + log_angle(focal, far) - np.log(from_place_m / np.maximum(from_photo_m, TINY_M)),
        most - least,
        area_sr(focal, seen.short),
    )


def likelihood_ratio(missed: Misses, noise_rad: float) -> FloatArray:
    """How much better than chance a pose explains each match, (M,)."""
    far = (missed.across_rad**2 + missed.beyond_rad**2) / noise_rad**2
    dense = _tailed(far, TAIL_WIDTH**2)
    width = np.sqrt(2.0 * np.pi) * noise_rad
    ratio = missed.area_sr * dense / (width * (missed.arc_rad + width))
    size = _tailed((missed.log_scale / SCALE_NOISE) ** 2, TAIL_WIDTH)
    return np.asarray(ratio * size * CHANCE_SCALE / SCALE_NOISE, dtype=np.float64)


def belonging(seen: Sightings, ratio: FloatArray) -> FloatArray:
    """Probability (M,) that each match belongs to a pose; matches of one keypoint count as one together."""
    each = seen.right * ratio / (1.0 - seen.right + seen.right * ratio)
    together = np.bincount(seen.keypoint, weights=each)[seen.keypoint]
    return np.asarray(each / np.maximum(together, 1.0), dtype=np.float64)


def score(seen: Sightings, pose: PhotoPose) -> tuple[float, BoolArray]:
    """Evidence of a pose, nats, and the matches (M,) that it explains.

    Matches of one keypoint with several panoramas are neither independent nor the same: their sum counts by
    the root of their number. Of sum, mean, greatest and this, it keeps wrong poses lowest.
    """
    ratio = likelihood_ratio(misses(seen, pose), NOISE_RAD)
    nats = np.log1p(seen.right * (ratio - 1.0))
    count = np.bincount(seen.keypoint)
    total = np.bincount(seen.keypoint, weights=nats) / np.sqrt(np.maximum(count, 1))
    explained: BoolArray = seen.right * ratio > 1.0 - seen.right
    return float(total.sum()), explained


def _tailed(squared: FloatArray, tail: float) -> FloatArray:
    """Normal density with a wide tail, up to its constant."""
    near = (1.0 - TAIL_SHARE) * np.exp(-0.5 * squared)
    return np.asarray(near + TAIL_SHARE / tail * np.exp(-0.5 * squared / TAIL_WIDTH**2), dtype=np.float64)
