"""A robot that rocks on its legs: it swings after changes of speed and edges that it rolls over. Pure.

Each axis is a damped oscillator, theta'' = -2 D W theta' - W^2 (theta - theta_rest). While the robot's speed
changes, theta_rest is off level, as of a body on springs; edges (thresholds, carpets) strike the rate.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from simulator.disturbances.levels import generator
from simulator.sensors.attitude import PitchRoll

RMS_RAD = math.radians(3.0)  # of pitch and of roll each, while driving, at level 1
# All chosen: a body of 18 kg on soft tyres, which swings by a twentieth after W D t = 3, 1.5 s.
W_RADPS, D = 2.0 * math.pi * 1.5, 0.21
FULL_MPS, SLOW_MPS = 0.4, 0.2  # full speed indoors, and what is left of it beside obstacles
LEAN_RAD_PER_MPS2 = 0.01  # braking from full speed at once pitches the nose down by 1.7 degrees
EDGE_EVERY_M = 0.2  # mean way between edges, which lie half as far to half again as far apart
# At length strikes s of mean frequency f give an axis a variance of f s^2 / (4 D W^3). By this factor legs
# of 8 s, rest to rest, have 3.1° (tests/unit/simulator/disturbances/test_rocking.py); an exploration, 2.9.
STRIKE = 1.1
EDGE_RADPS = STRIKE * RMS_RAD * math.sqrt(4.0 * D * W_RADPS**3 * EDGE_EVERY_M / FULL_MPS)


@dataclass(frozen=True)
class Rocking:
    """State between two steps, at level 1.

    Attributes:
        pitch_rad, roll_rad: nose down and left up positive.
        pitch_radps, roll_radps: their rates.
        velocity_mps: of the robot, along x and y of its own frame.
        way_m: left to the next edge; None before the first one is drawn.
        edges: how many were rolled over.
    """

    pitch_rad: float = 0.0
    roll_rad: float = 0.0
    pitch_radps: float = 0.0
    roll_radps: float = 0.0
    velocity_mps: tuple[float, float] = (0.0, 0.0)
    way_m: float | None = None
    edges: int = 0

    def tilt(self, level: float) -> PitchRoll:
        """Pitch and roll at a level, radians; (0, 0) at level 0."""
        return level * self.pitch_rad, level * self.roll_rad

    def lifted(self) -> "Rocking":
        """Level and at rest, as after being put down somewhere; edges to come stay the same."""
        return Rocking(way_m=self.way_m, edges=self.edges)


def step(state: Rocking, velocity_mps: tuple[float, float], dt_s: float, seed: int) -> Rocking:
    """The state after a moment in which the robot came to a velocity (x ahead, y left, its own frame)."""
    change = [(new - old) / dt_s for new, old in zip(velocity_mps, state.velocity_mps, strict=True)]
    # Braking puts the nose down; a body that is pushed to the left raises its left side.
    rest_rad = -LEAN_RAD_PER_MPS2 * change[0], LEAN_RAD_PER_MPS2 * change[1]
    pitch_rad, pitch_radps = _swing(state.pitch_rad, state.pitch_radps, rest_rad[0], dt_s)
    roll_rad, roll_radps = _swing(state.roll_rad, state.roll_radps, rest_rad[1], dt_s)
    moved = replace(
        state,
        pitch_rad=pitch_rad, roll_rad=roll_rad, pitch_radps=pitch_radps, roll_radps=roll_radps,
        velocity_mps=velocity_mps,
    )  # fmt: skip
    return _rolled(moved, dt_s, seed)


def drawn(sigma_rad: float, rng: np.random.Generator) -> PitchRoll:
    """Pitch and roll of a moment of driving, normal and independent."""
    pitch_rad, roll_rad = (float(angle) for angle in sigma_rad * rng.standard_normal(2))
    return pitch_rad, roll_rad


def _swing(angle_rad: float, rate_radps: float, rest_rad: float, dt_s: float) -> tuple[float, float]:
    rate_radps += dt_s * (-2.0 * D * W_RADPS * rate_radps - W_RADPS**2 * (angle_rad - rest_rad))
    return angle_rad + dt_s * rate_radps, rate_radps


def _rolled(state: Rocking, dt_s: float, seed: int) -> Rocking:
    """Roll on, over at most one edge."""
    speed_mps = math.hypot(*state.velocity_mps)
    way_m = _gap_m(seed, 0) if state.way_m is None else state.way_m
    way_m -= speed_mps * dt_s
    if way_m > 0.0:
        return replace(state, way_m=way_m)
    direction = float(generator(seed, "rocking", state.edges).uniform(-math.pi, math.pi))
    strike_radps = math.sqrt(2.0) * EDGE_RADPS * _strength(speed_mps)
    return replace(
        state,
        pitch_radps=state.pitch_radps + strike_radps * math.cos(direction),
        roll_radps=state.roll_radps + strike_radps * math.sin(direction),
        way_m=_gap_m(seed, state.edges + 1),
        edges=state.edges + 1,
    )


def _gap_m(seed: int, number: int) -> float:
    return float(generator(seed, "rocking way", number).uniform(0.5, 1.5) * EDGE_EVERY_M)


def _strength(speed_mps: float) -> float:
    """Of a strike against EDGE_RADPS: the faster, the shorter it is, so that RMS_RAD holds at any speed."""
    return math.sqrt(FULL_MPS / max(speed_mps, SLOW_MPS)) * min(1.0, speed_mps / SLOW_MPS)
