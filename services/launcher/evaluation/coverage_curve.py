"""How much of the floor a map covers, by how far the robot had driven. Pure."""

from collections.abc import Mapping, Sequence
from itertools import accumulate, pairwise

import numpy as np
import numpy.typing as npt

from services.launcher.client.trail import driven_m
from services.launcher.evaluation.truth_file import MapTruth
from shared.messages.simulation import Truth

FloatArray = npt.NDArray[np.float64]
Curve = list[tuple[float, float]]


def coverage_curve(floor_m: FloatArray, truth: MapTruth, truths: Sequence[Truth], radius_m: float) -> Curve:
    """Driven metres and the share of floor within `radius_m` of a node, after each node.

    Args:
        floor_m: (N, 2) centres of equal cells of the free floor, metres.
        truth: where the nodes truly are, and when their frames were taken.
        truths: true states of the mission, in order; nodes from before it count at 0 m.
        radius_m: how far a node reaches, metres.
    """
    driven = _driven_at(truths)
    left = floor_m
    curve: Curve = []
    for node in sorted(truth.poses, key=lambda node: truth.stamps_ns[node]):
        pose = truth.poses[node]
        left = left[np.hypot(left[:, 0] - pose.x_m, left[:, 1] - pose.y_m) > radius_m]
        curve.append((driven.get(truth.stamps_ns[node], 0.0), 1.0 - len(left) / len(floor_m)))
    return sorted(curve)


def metres_to(curve: Curve, share: float) -> float | None:
    """How far the robot had driven when the map covered so much; None where it never did."""
    return next((metres for metres, covered in curve if covered >= share), None)


def _driven_at(truths: Sequence[Truth]) -> Mapping[int, float]:
    """Driven metres by the capture time of a frame."""
    steps = [0.0, *(driven_m([a, b]) for a, b in pairwise(truths))]
    return dict(zip((truth.stamp_ns for truth in truths), accumulate(steps), strict=False))
