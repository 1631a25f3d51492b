"""How much of each patch of two panoramas the other shows nowhere near. Pure.

From a spot some centimetres away the same things stand elsewhere, near ones by many degrees. So every patch
is compared with the other picture at all bearings within reach, and its best likeness counts. The share of
two patches a and b that is not alike is |a - b|^2 / (|a|^2 + |b|^2 + FLOOR): 0 for equal ones and for two
that show nothing, near 1 where only one shows something.
"""

import cv2
import numpy as np
import numpy.typing as npt

from services.features.changes.signature import Signature

PATCH_PX = 9
"""Side of a patch: 8 degrees, a chair two metres away is one and a half of them wide."""
FLOOR = 0.004
"""What counts as showing nothing, mean square of a signature; chosen: below an edge of 1 %."""
RISE = 0.45
"""How far up or down things shift, of how far sideways: the camera stays at one height."""
LEAST_PX = 2

Map = npt.NDArray[np.float32]


def unexplained(reference: Signature, current: Signature, rows: slice, reach_px: int) -> tuple[Map, Map]:
    """The least share that is not alike, for each patch of either picture; both look the same way.

    Args:
        reference: (H, W, C) signature of one picture.
        current: the same of the other.
        rows: that are compared; reach and half a patch must lie beyond them on both sides.
        reach_px: how far sideways the same thing may stand.

    Returns:
        (rows, W) for patches of the reference, and for those of the current picture.
    """
    half, up_px = PATCH_PX // 2, max(LEAST_PX, round(RISE * reach_px))
    side = reach_px + half + 1
    there = _wrapped(reference[rows.start - up_px - half : rows.stop + up_px + half], 2 * side)
    here = _wrapped(current[rows.start - half : rows.stop + half], side)
    height, width = rows.stop - rows.start, current.shape[1]
    energy_there, energy_here = _mean((there**2).sum(axis=-1)), _mean((here**2).sum(axis=-1))
    energy_here = energy_here[half : half + height, side:-side] + FLOOR
    of_reference = np.full((height, width), np.inf, np.float32)
    of_current = of_reference.copy()
    for dy in range(-up_px, up_px + 1):
        for dx in range(-reach_px, reach_px + 1):
            top, left = up_px + dy, side + dx
            shifted = there[top : top + height + 2 * half, left : left + width + 2 * side]
            alike = _mean(np.einsum("ijk,ijk->ij", shifted, here))[half : half + height, side:-side]
            energy = energy_here + energy_there[half:][top : top + height, left + side : left + side + width]
            share = (energy - FLOOR - 2.0 * alike) / energy
            np.minimum(of_current, share, out=of_current)
            _lower(of_reference, np.roll(share, dx, axis=1), dy)
    # What left the rows was not looked for everywhere: there the other picture says it.
    for edge in (slice(None, up_px), slice(-up_px, None)):
        of_reference[edge] = np.minimum(of_reference[edge], of_current[edge])
    return of_reference, of_current


def _wrapped(part: Signature, side_px: int) -> Signature:
    return np.concatenate([part[:, -side_px:], part, part[:, :side_px]], axis=1)


def _mean(values: Map) -> Map:
    return np.asarray(cv2.blur(values, (PATCH_PX, PATCH_PX)), np.float32)


def _lower(least: Map, share: Map, down: int) -> None:
    """Take over smaller shares, of rows that lie so much further down."""
    mine = slice(max(down, 0), len(least) + min(down, 0))
    theirs = slice(max(-down, 0), len(least) + min(-down, 0))
    np.minimum(least[mine], share[theirs], out=least[mine])
