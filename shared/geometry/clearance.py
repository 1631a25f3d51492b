"""How far the robot can go in a direction, from 12 distances with wide beams."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

HALF_BEAM_RAD = math.radians(12.0)
"""Part of a beam of 30 degrees (decision 0006) that an echo is spread over to either side; chosen: 3 degrees
less, as its neighbour covers the rest."""
ARC_POINTS = 5
"""Points per echo; chosen: 6 degrees apart, 5 cm at the look-ahead of half a metre."""
NEARER_M = 0.08
"""A neighbour that reads this much less has the nearer end of the same surface; chosen: more than five
standard deviations of the difference of two readings with 1 cm of noise."""
GAP_M = 0.4
"""A neighbour that reads this much more looks past the end of the surface; chosen: more than the
steps of furniture, less than what lies behind a doorway."""
MIDDLE = 0.2
"""Share of the half beam at which the half that holds an echo begins: beyond the middle where the neighbour
reads less, before it beside a gap; chosen: 2.4 degrees."""
SEEN = 0.98
"""Share of the largest range from which on nothing was seen: its noise of 1 cm stays within 2 % of 4 m."""


STRAIGHT_PER_M = 1e-3
"""An arc that bends less is a line: it is off by 0.5 mm after a metre."""


@dataclass(frozen=True)
class Obstacles:
    """Points in the robot frame that may be obstacles.

    Attributes:
        points_m: (P, 2) x ahead, y left.
    """

    points_m: FloatArray

    @staticmethod
    def from_ranges(
        angles_rad: Sequence[float], distances_m: Sequence[float], max_range_m: float
    ) -> "Obstacles":
        """Spread each echo nearer than `max_range_m` over the part of its beam it may come from.

        An echo can come from anywhere in the beam. Where a neighbouring sensor reads clearly less, both see
        one surface that runs towards that neighbour: the echo then lies in that half of the beam. So it does
        where one neighbour reads the same and the other looks through a gap: a doorway little wider than the
        robot stays open.

        Args:
            angles_rad: axes of the sensors in ascending order round the robot.
            distances_m: one reading each.
            max_range_m: reading of a sensor that sees nothing.
        """
        angles, distances = np.asarray(angles_rad), np.asarray(distances_m)
        left, right = np.roll(distances, -1), np.roll(distances, 1)
        low = np.where((left < distances - NEARER_M) & (left <= right), MIDDLE, -1.0)
        high = np.where((right < distances - NEARER_M) & (right < left), -MIDDLE, 1.0)
        low = np.where((np.abs(left - distances) < NEARER_M) & (right > distances + GAP_M), -MIDDLE, low)
        high = np.where((np.abs(right - distances) < NEARER_M) & (left > distances + GAP_M), MIDDLE, high)
        low, high = low * HALF_BEAM_RAD, high * HALF_BEAM_RAD
        share = np.linspace(0.0, 1.0, ARC_POINTS)
        arcs_rad = angles[:, None] + low[:, None] + (high - low)[:, None] * share
        seen = distances < max_range_m * SEEN
        arc_rad, reach_m = arcs_rad[seen].ravel(), np.repeat(distances[seen], ARC_POINTS)
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
        free_m: FloatArray = np.where(touches, np.maximum(forward_m - chord_m, 0.0), np.inf).min(axis=1)
        return free_m

    def arc_clearance_m(self, bend_per_m: float, radius_m: float, *, backwards: bool = False) -> float:
        """Way that a disc can go along an arc before it touches a point; inf where it never does.

        A point behind the disc never blocks, as in `clearance_m`.

        Args:
            bend_per_m: curvature, positive to the left of who looks ahead, also where he goes backwards.
            radius_m: of the disc.
            backwards: whether it goes backwards.
        """
        sign = -1.0 if backwards else 1.0
        if abs(bend_per_m) < STRAIGHT_PER_M:
            return float(self.clearance_m(np.array([math.pi if backwards else 0.0]), radius_m)[0])
        if not len(self.points_m):
            return math.inf
        # Seen from the middle of the circle, which lies to the left: the disc goes round by `turned_rad`.
        circle_m, left = 1.0 / abs(bend_per_m), math.copysign(1.0, bend_per_m)
        ahead_m, aside_m = sign * self.points_m[:, 0], circle_m - left * self.points_m[:, 1]
        apart_m, turned_rad = np.hypot(ahead_m, aside_m), np.arctan2(ahead_m, aside_m)
        reach = (circle_m**2 + apart_m**2 - radius_m**2) / np.maximum(2.0 * circle_m * apart_m, 1e-9)
        touches = (np.abs(reach) < 1.0) & (turned_rad > 0.0)
        if not touches.any():
            return math.inf
        contact_rad = turned_rad[touches] - np.arccos(reach[touches])
        return float(np.maximum(contact_rad, 0.0).min()) * circle_m
