"""How much floor and wall a piece of furniture takes. Pure."""

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from shared.geometry.perspective import rotation_z
from simulator.furniture.catalogue import FURNITURE
from simulator.generation.plans.rectangles import Point, Rect
from simulator.world.freespace import BODY_BAND_M


@dataclass(frozen=True)
class Extent:
    """A piece in its own frame, metres.

    Attributes:
        box: all of it, seen from above.
        solid: whether the robot can run into it.
        low_m, high_m: its heights above its anchor.
    """

    box: Rect
    solid: bool
    low_m: float
    high_m: float


def extent(kind: str, options: dict[str, Any], seed: int) -> Extent:
    """Of a piece as it will be built."""
    return _extent(kind, repr(sorted(options.items())), _Options(options), seed)


class _Options(dict[str, Any]):
    """Options that are equal where their text is: they hold lists."""

    def __hash__(self) -> int:  # type: ignore[override]
        return hash(repr(sorted(self.items())))


@lru_cache(maxsize=4096)
def _extent(kind: str, text: str, options: _Options, seed: int) -> Extent:  # noqa: ARG001
    parts = FURNITURE[kind].build(options, seed).parts
    if not parts:  # nothing but light
        return Extent(Rect(0.0, 0.0, 0.0, 0.0), False, 0.0, 0.0)
    corners, heights, solid = [], [], False
    for part in parts:
        half = np.array(part.size_m) / 2
        signs = np.array([(x, y) for x in (-1, 1) for y in (-1, 1)])
        turned = signs * half[:2] @ rotation_z(part.yaw_rad)[:2, :2].T
        corners.append(turned + np.array(part.centre_m[:2]))
        low, high = part.centre_m[2] - half[2], part.centre_m[2] + half[2]
        heights += [low, high]
        solid = solid or bool(part.solid and low < BODY_BAND_M[1] and high > BODY_BAND_M[0])
    every = np.concatenate(corners)
    box = Rect(*every.min(axis=0).tolist(), *every.max(axis=0).tolist())
    return Extent(box, solid, float(min(heights)), float(max(heights)))


def placed_box(box: Rect, at_m: Point, yaw_deg: float) -> Rect:
    """A box of a piece's own frame in the world, as an axis-parallel rectangle round it."""
    c, s = math.cos(math.radians(yaw_deg)), math.sin(math.radians(yaw_deg))
    xs, ys = zip(
        *((x * c - y * s, x * s + y * c) for x in (box.x0, box.x1) for y in (box.y0, box.y1)), strict=True
    )
    return Rect(min(xs), min(ys), max(xs), max(ys)).moved(*at_m)
