"""What is drawn by chance: pairs of pictures of different tours, pictures and axes to tilt. Pure."""

import math
from collections.abc import Sequence
from typing import TypeVar

import numpy as np

One = TypeVar("One")


def foreign_pairs(tour_of: Sequence[int], most: int, rng: np.random.Generator) -> list[tuple[int, int]]:
    """Pairs of pictures of different tours: all where there are at most `most`, else so many of them.

    Args:
        tour_of: number of the tour of each picture.
        most: pairs wanted at most.
        rng: draws them.
    """
    of = np.asarray(tour_of)
    a, b = np.triu_indices(len(of), 1)
    different = of[a] != of[b]
    a, b = a[different], b[different]
    kept = np.arange(len(a)) if len(a) <= most else np.sort(rng.choice(len(a), most, replace=False))
    return [(int(a[k]), int(b[k])) for k in kept]


def some(items: Sequence[One], most: int, rng: np.random.Generator) -> list[One]:
    """All items, or `most` of them, in their order."""
    if len(items) <= most:
        return list(items)
    return [items[int(k)] for k in np.sort(rng.choice(len(items), most, replace=False))]


def pitch_roll(angle_rad: float, axis_rad: float) -> tuple[float, float]:
    """Pitch and roll of a tilt by an angle about the horizontal axis at a longitude, radians."""
    return angle_rad * math.sin(axis_rad), angle_rad * math.cos(axis_rad)


def axes_rad(count: int, rng: np.random.Generator) -> list[float]:
    """Longitudes of horizontal axes, radians."""
    return [float(axis) for axis in rng.uniform(-math.pi, math.pi, count)]
