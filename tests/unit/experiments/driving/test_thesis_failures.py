"""Oscillation and being stuck, read off a driven way."""

import math

from experiments.driving.thesis_failures import longest_stay, reversals
from shared.messages.simulation import Pose, Truth


def way(*points):
    return [Truth(robot="r1", world="w", pose=Pose(x_m=x, y_m=y, yaw_rad=0.0)) for x, y in points]


def test_a_curve_has_no_reversal():
    arc = [(math.cos(a / 10), math.sin(a / 10)) for a in range(60)]
    assert reversals(way(*arc)) == 0


def test_every_turn_back_counts():
    assert reversals(way((0, 0), (0.2, 0), (0.1, 0), (0.2, 0), (0.4, 0))) == 2


def test_noise_of_standing_still_is_no_turn():
    assert reversals(way(*[(0.01 * (-1) ** k, 0.0) for k in range(50)])) == 0


def test_longest_stay_counts_frames_on_one_spot():
    still = [(1.0, 0.01 * (k % 3)) for k in range(30)]
    moving = [(1.0 + 0.3 * k, 0.0) for k in range(1, 20)]
    assert longest_stay(way(*still, *moving), 0.5) in (31, 32)
    assert longest_stay(way(*moving), 0.5) == 2
    assert longest_stay([], 0.5) == 0
