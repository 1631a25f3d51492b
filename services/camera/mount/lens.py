"""A fisheye lens that may see more than half of the sphere: the model of Kannala and Brandt. Pure.

Lens frame: x right and y down in the picture, z along the axis. A bearing at angle theta from the axis lies
    r = f theta (1 + k1 theta^2 + k2 theta^4 + k3 theta^6 + k4 theta^8)
pixels from the centre, in its own direction ("A generic camera model and calibration method for conventional,
wide-angle, and fish-eye lenses", IEEE PAMI 2006, equation 6). OpenCV's `fisheye` has the same equation but
divides by z, so what lies beyond 90 degrees comes out mirrored; this one goes on.
"""

import math
from dataclasses import dataclass

import numpy as np

from shared.geometry.sphere import FloatArray, with_last_axis

STEPS = 12
"""Of Newton's method for theta; chosen: the fifth changes nothing any more on lenses up to 220 degrees."""
WIDEST_RAD = math.radians(115.0)
"""No lens of a 360-degree camera sees further from its axis; chosen."""


@dataclass(frozen=True)
class Lens:
    """One lens.

    Attributes:
        focal_px: f, pixels per radian at the axis.
        centre_px: where the axis meets the picture, (u, v).
        distortion: k1 to k4.
    """

    focal_px: float
    centre_px: tuple[float, float]
    distortion: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)

    def radius_px(self, theta_rad: FloatArray) -> FloatArray:
        """Distance from the centre, pixels, for angles from the axis of any shape."""
        square = theta_rad * theta_rad
        k1, k2, k3, k4 = self.distortion
        bent = 1.0 + square * (k1 + square * (k2 + square * (k3 + square * k4)))
        return np.asarray(self.focal_px * theta_rad * bent, dtype=np.float64)

    def pixels(self, bearings: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Map (..., 3) bearings in the lens frame to (..., 2) pixels, and (...) angles from the axis, rad."""
        b = with_last_axis("bearings", bearings, 3)
        aside = np.hypot(b[..., 0], b[..., 1])
        theta = np.arctan2(aside, b[..., 2])
        scale = self.radius_px(theta) / np.maximum(aside, 1e-12)
        u = self.centre_px[0] + scale * b[..., 0]
        v = self.centre_px[1] + scale * b[..., 1]
        return np.stack([u, v], axis=-1), theta

    def bearings(self, pixels: FloatArray) -> FloatArray:
        """Map (..., 2) pixels to (..., 3) unit bearings in the lens frame."""
        d = with_last_axis("pixels", pixels, 2) - np.asarray(self.centre_px)
        radius = np.hypot(d[..., 0], d[..., 1])
        theta = self.angle_rad(radius)
        scale = np.sin(theta) / np.maximum(radius, 1e-12)
        return np.stack([scale * d[..., 0], scale * d[..., 1], np.cos(theta)], axis=-1)

    def angle_rad(self, radius_px: FloatArray) -> FloatArray:
        """Angle from the axis for distances from the centre of any shape: `radius_px` the other way round."""
        k1, k2, k3, k4 = self.distortion
        theta = np.clip(np.asarray(radius_px, dtype=np.float64) / self.focal_px, 0.0, WIDEST_RAD)
        for _ in range(STEPS):
            square = theta * theta
            slope = 1.0 + square * (3 * k1 + square * (5 * k2 + square * (7 * k3 + square * 9 * k4)))
            step = (self.radius_px(theta) - radius_px) / (self.focal_px * np.maximum(slope, 0.05))
            theta = np.clip(theta - step, 0.0, WIDEST_RAD)
        return np.asarray(theta, dtype=np.float64)

    def grows_to(self, theta_rad: float) -> bool:
        """Whether the radius only grows up to this angle: a lens that turns back there is a bad fit."""
        radius = self.radius_px(np.linspace(0.0, theta_rad, 200))
        return bool(np.all(np.diff(radius) > 0.0))
