"""How far the robot can go in a direction, from 12 distances with wide beams."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

BEAM_OFFSETS_RAD = np.deg2rad([-12.0, -6.0, 0.0, 6.0, 12.0])
"""An echo may come from anywhere in the beam: these points of its arc stand for it."""


@dataclass(frozen=True)
class Obstacles:
    """Points in the robot frame that may be obstacles.

    Attributes:
        points_m: (P, 2) x ahead, y left.
    """

    points_m: FloatArray

    @staticmethod
    def from_ranges(
        angles_rad: tuple[float, ...], distances_m: tuple[float, ...], max_range_m: float
    ) -> "Obstacles":
        """Spread each echo nearer than `max_range_m` over its beam."""
        angles, distances = np.asarray(angles_rad), np.asarray(distances_m)
        seen = distances < max_range_m * 0.98
        arc_rad = (angles[seen, None] + BEAM_OFFSETS_RAD).ravel()
        reach_m = np.repeat(distances[seen], len(BEAM_OFFSETS_RAD))
        return Obstacles(np.stack([reach_m * np.cos(arc_rad), reach_m * np.sin(arc_rad)], axis=-1))

    def clearance_m(self, headings_rad: FloatArray, radius_m: float) -> FloatArray:
        """Distance a disc of `radius_m` can travel along each heading before it touches a point.

        A point behind the disc's centre line never blocks: a robot that stands too near can leave.
        """
        ahead = np.stack([np.cos(headings_rad), np.sin(headings_rad)], axis=-1)
        if not len(self.points_m):
            return np.full(len(headings_rad), np.inf)
        forward_m = ahead @ self.points_m.T
        lateral_m = np.abs(ahead[:, :1] * self.points_m[:, 1] - ahead[:, 1:] * self.points_m[:, 0])
        touches = (forward_m > 0.0) & (lateral_m < radius_m)
        chord_m = np.sqrt(np.clip(radius_m**2 - lateral_m**2, 0.0, None))
        return np.where(touches, np.maximum(forward_m - chord_m, 0.0), np.inf).min(axis=1)

    def nearest(self) -> tuple[float, float]:
        """Distance (m) and bearing (rad) of the nearest point; infinity and 0 when nothing is seen."""
        if not len(self.points_m):
            return np.inf, 0.0
        distances = np.hypot(self.points_m[:, 0], self.points_m[:, 1])
        nearest = int(distances.argmin())
        return float(distances[nearest]), float(np.arctan2(*self.points_m[nearest, ::-1]))
