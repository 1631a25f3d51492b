"""How much of the floor a map covers, by how far the robot had driven. Pure."""

from collections.abc import Sequence
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
    nodes = sorted(truth.poses, key=lambda node: truth.stamps_ns[node])
    way_m = _driven_at([truth.stamps_ns[node] for node in nodes], truths)
    left = floor_m
    curve: Curve = []
    for node, metres in zip(nodes, way_m, strict=True):
        pose = truth.poses[node]
        left = left[np.hypot(left[:, 0] - pose.x_m, left[:, 1] - pose.y_m) > radius_m]
        curve.append((metres, 1.0 - len(left) / len(floor_m)))
    return sorted(curve)


def metres_to(curve: Curve, share: float) -> float | None:
    """How far the robot had driven when the map covered so much; None where it never did."""
    return next((metres for metres, covered in curve if covered >= share), None)


def _driven_at(stamps_ns: Sequence[int], truths: Sequence[Truth]) -> list[float]:
    """Driven metres at the capture times of frames, between two states where none has that time."""
    if not truths:
        return [0.0] * len(stamps_ns)
    began_ns = truths[0].stamp_ns  # nanoseconds since 1970 are too many digits for a float
    steps = [0.0, *(driven_m([a, b]) for a, b in pairwise(truths))]
    known_s = [1e-9 * (truth.stamp_ns - began_ns) for truth in truths]
    asked_s = [1e-9 * (stamp_ns - began_ns) for stamp_ns in stamps_ns]
    return [float(one) for one in np.interp(asked_s, known_s, list(accumulate(steps)))]
