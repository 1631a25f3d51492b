"""Furniture that hangs in the air: nothing below it, beside it or above it that holds it. Pure."""

import numpy as np
import numpy.typing as npt

from simulator.scene.parts import Part, rotation_of
from simulator.world.contents import placed
from simulator.world.footprints import clearance_m, footprints
from simulator.world.world_file import WorldFile

FloatArray = npt.NDArray[np.float64]
TOUCH_M = 0.06  # what is no further from a support rests on it; chosen: models are placed by eye
ON_FLOOR_M = 0.06
CEILING_M = 2.0  # what hangs higher hangs from a ceiling, whether the world has one or not; chosen
MODELS = "mesh"  # our own furniture is drawn where it belongs


def floating(world: WorldFile) -> list[str]:
    """Names and heights of models that nothing holds."""
    if not any(item.kind == MODELS for item in world.furniture):
        return []
    pieces = [placed(item).parts for item in world.furniture]
    extents = [_extent(parts) for parts in pieces]
    found = []
    for k, (item, box) in enumerate(zip(world.furniture, extents, strict=True)):
        if item.kind != MODELS or box is None:
            continue
        low, high = box
        if not ON_FLOOR_M < low[2] < CEILING_M:
            continue
        others = [
            part
            for j, (parts, other) in enumerate(zip(pieces, extents, strict=True))
            if j != k and other is not None and _near(box, other)
            for part in parts
        ]
        if not _held(low, high, tuple(others)):
            found.append(f"{item.name or f'furniture.{k}'} ({low[2]:.2f} m up)")
    return found


def _held(low: FloatArray, high: FloatArray, others: tuple[Part, ...]) -> bool:
    """Whether something solid is as near to a box as things are that rest on it, hang on it or lean at it."""
    xs, ys = np.linspace(low[0], high[0], 5), np.linspace(low[1], high[1], 5)
    points = np.stack(np.meshgrid(xs, ys), axis=-1).reshape(-1, 2)
    shapes = footprints(others, float(low[2]) - TOUCH_M, float(high[2]) + TOUCH_M)
    return float(clearance_m(points, shapes).min()) <= TOUCH_M


def _near(a: tuple[FloatArray, FloatArray], b: tuple[FloatArray, FloatArray]) -> bool:
    return bool((a[0] - TOUCH_M <= b[1]).all() and (b[0] - TOUCH_M <= a[1]).all())


def _extent(parts: tuple[Part, ...]) -> tuple[FloatArray, FloatArray] | None:
    """Corners of a box round all parts, world frame; None without any."""
    if not parts:
        return None
    corners = []
    signs = np.array([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
    for part in parts:
        corners.append(signs * np.array(part.size_m) @ rotation_of(part).T + np.array(part.centre_m))
    points = np.concatenate(corners)
    return points.min(axis=0), points.max(axis=0)
