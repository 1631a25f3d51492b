"""A room of points, panoramas at known places, and a photo from anywhere: matches with a known answer."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.perspective import rotation_y, rotation_z
from shared.geometry.photo.plane import focal_of, log_angle, rays
from shared.geometry.photo.sightings import PhotoPose, Sightings
from shared.geometry.sphere import bearings_from_lonlat, lonlat_from_bearings
from tests.unit.shared.geometry.synthetic_room import rotation_x

NOISE_RAD = np.deg2rad(0.2)
SIZE_NOISE = 0.1
POINTS = 900


@dataclass(frozen=True)
class Shot:
    """A photo: where, how it is turned, and its field of view over the longer side."""

    position_m: tuple[float, float, float] = (0.4, 0.3, 0.1)
    yaw_rad: float = 0.6
    pitch_rad: float = 0.2
    roll_rad: float = -0.07
    fov_rad: float = 1.25
    aspect: float = 4.0 / 3.0

    @property
    def rotation(self):
        return rotation_z(self.yaw_rad) @ rotation_y(-self.pitch_rad) @ rotation_x(self.roll_rad)

    @property
    def pose(self):
        return PhotoPose(self.rotation, np.array(self.position_m), np.log(focal_of(self.fov_rad)))


def room(rng):
    """Points on the walls of a room of 7 x 6 m, 1.5 m below to 1.2 m above the cameras."""
    wall = rng.integers(4, size=POINTS)
    along, up = rng.uniform(-1.0, 1.0, POINTS), rng.uniform(-1.5, 1.2, POINTS)
    x = np.where(wall < 2, 3.5 * along, np.where(wall == 2, 3.5, -3.5))
    y = np.where(wall < 2, np.where(wall == 0, 3.0, -3.0), 3.0 * along)
    inwards = 1.0 - 0.4 * rng.random(POINTS)  # furniture stands before walls
    return np.stack([x * inwards, y * inwards, up], axis=1)


def on_plane(points, shot):
    """Points of the photo's plane (N, 2), how far each is (N,), and which it shows (N,)."""
    local = (points - np.array(shot.position_m)) @ shot.rotation
    ahead = np.where(local[:, 0] > 0.05, local[:, 0], np.nan)
    plane = focal_of(shot.fov_rad) * local[:, 1:] / ahead[:, None]
    wide, high = (1.0, 1.0 / shot.aspect) if shot.aspect >= 1.0 else (shot.aspect, 1.0)
    shown = (np.abs(plane[:, 0]) < wide) & (np.abs(plane[:, 1]) < high)
    return plane, np.linalg.norm(local, axis=1), shown


def sightings(rng, shot, places, wrong=0.4):
    """Matches of the photo with panoramas at places (x, y), whose axes are the room's.

    Args:
        rng: draws points and noise.
        shot: the photo.
        places: of the panoramas.
        wrong: share of matches whose points have nothing to do with each other.
    """
    points = room(rng)
    plane, far_m, shown = on_plane(points, shot)
    rows = np.flatnonzero(shown)
    parts = []
    for x_m, y_m in places:
        place = np.array([x_m, y_m, 0.0])
        kept = rows[rng.random(len(rows)) < 0.35]
        seen = points[kept] - place
        lonlat = lonlat_from_bearings(seen) + rng.normal(0.0, NOISE_RAD, (len(kept), 2))
        away_m = np.linalg.norm(seen, axis=1)
        _, off = rays(plane[kept], focal_of(shot.fov_rad))
        size = np.log(away_m / far_m[kept]) - log_angle(focal_of(shot.fov_rad), off)
        bad = rng.random(len(kept)) < wrong
        lonlat[bad] = np.stack([rng.uniform(-3.1, 3.1, bad.sum()), rng.uniform(-1.0, 1.0, bad.sum())], axis=1)
        parts.append((place, kept, lonlat, size + rng.normal(0.0, SIZE_NOISE, len(kept))))
    keypoint = np.concatenate([kept for _, kept, _, _ in parts])
    return Sightings(
        plane=plane[keypoint],
        place_m=np.concatenate([np.tile(place, (len(kept), 1)) for place, kept, _, _ in parts]),
        direction=np.concatenate([bearings_from_lonlat(lonlat) for _, _, lonlat, _ in parts]),
        right=np.full(len(keypoint), 1.0 - wrong),
        log_size=np.concatenate([size for _, _, _, size in parts]),
        keypoint=keypoint.astype(np.intp),
        short=min(shot.aspect, 1.0 / shot.aspect),
    )
