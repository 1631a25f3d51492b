"""Lenses and poses of boards that explain the corners best: least squares by Levenberg and Marquardt. Pure.

Unknown are, of each lens, focal length, centre and four coefficients; of the second its pose to the first;
and the pose of every board to the first lens. A board that both lenses see ties them together.
"""

from collections.abc import Callable

import cv2
import numpy as np

from services.camera.calibration.board import Corners
from services.camera.mount.lens import Lens
from shared.geometry.sphere import FloatArray

LENS = 7
"""Unknowns of a lens: focal length and centre over the first guess's focal length, four coefficients."""
STEPS = 60
ENOUGH = 1e-7
"""Relative gain of a step after which nothing changes any more; chosen."""
DELTA = 1e-6
"""Step of a difference quotient; chosen: the root of what doubles resolve, and rounding stays far below."""

View = tuple[Corners | None, Corners | None]


def lens_of(unknowns: FloatArray, scale_px: float) -> Lens:
    """The lens of seven unknowns."""
    focal, u, v, *bend = (float(x) for x in unknowns)
    k1, k2, k3, k4 = bend
    return Lens(focal * scale_px, (u * scale_px, v * scale_px), (k1, k2, k3, k4))


def pose_of_board(corners: Corners, lens: Lens) -> tuple[FloatArray, FloatArray]:
    """Rotation (3, 3) and place (3,) of a board in the lens frame, in squares.

    The bearings are turned so that their middle lies ahead: a pinhole sees them all, however far aside.
    """
    bearings = lens.bearings(corners.pixels)
    middle = bearings.mean(axis=0)
    turn = _onto_axis(middle / np.linalg.norm(middle))
    ahead = bearings @ turn.T
    flat = ahead[:, :2] / ahead[:, 2:]
    points = np.column_stack([corners.points, np.zeros(len(corners.points))])
    _, turned, place = cv2.solvePnP(points, flat, np.eye(3), None, flags=cv2.SOLVEPNP_IPPE)
    return turn.T @ cv2.Rodrigues(turned)[0], turn.T @ place.ravel()


def residuals(unknowns: FloatArray, views: list[View], scale_px: float) -> FloatArray:
    """What every corner is off by, pixels, (2 N,)."""
    lenses = lens_of(unknowns[:LENS], scale_px), lens_of(unknowns[LENS : 2 * LENS], scale_px)
    off = [view_residuals(unknowns, number, view, lenses) for number, view in enumerate(views)]
    return np.concatenate(off)


def view_residuals(unknowns: FloatArray, number: int, view: View, lenses: tuple[Lens, Lens]) -> FloatArray:
    """What the corners of one view are off by, pixels, (2 N,)."""
    second = cv2.Rodrigues(unknowns[2 * LENS : 2 * LENS + 3])[0], unknowns[2 * LENS + 3 : 2 * LENS + 6]
    pose = unknowns[2 * LENS + 6 + 6 * number :][:6]
    turn = cv2.Rodrigues(pose[:3])[0]
    off = []
    for which, corners in enumerate(view):
        if corners is None:
            continue
        seen = corners.points @ turn[:, :2].T + pose[3:]
        if which == 1:
            seen = seen @ second[0].T + second[1]
        off.append((lenses[which].pixels(seen)[0] - corners.pixels).ravel())
    return np.concatenate(off)


def fitted(start: FloatArray, views: list[View], scale_px: float) -> FloatArray:
    """The unknowns that explain all corners best, from a first guess."""
    unknowns, damping = start, 1e-3
    off = residuals(unknowns, views, scale_px)
    for _ in range(STEPS):
        slope = _slopes(lambda x: residuals(x, views, scale_px), unknowns, off)
        square, pull = slope.T @ slope, slope.T @ off
        better = None
        while better is None and damping < 1e8:
            step = np.linalg.solve(square + damping * np.diag(np.diag(square) + 1e-9), -pull)
            tried = residuals(unknowns + step, views, scale_px)
            better = tried if tried @ tried < off @ off else None
            damping *= 0.3 if better is not None else 10.0
        if better is None:
            break
        gain = 1.0 - (better @ better) / (off @ off)
        unknowns, off = unknowns + step, better
        if gain < ENOUGH:
            break
    return unknowns


def _slopes(function: Callable[[FloatArray], FloatArray], at: FloatArray, value: FloatArray) -> FloatArray:
    slope = np.empty((len(value), len(at)))
    for column in range(len(at)):
        moved = at.copy()
        moved[column] += DELTA
        slope[:, column] = (function(moved) - value) / DELTA
    return slope


def _onto_axis(bearing: FloatArray) -> FloatArray:
    """Rotation (3, 3) that turns a unit bearing (3,) onto z."""
    aside = np.cross([0.0, 1.0, 0.0] if abs(bearing[1]) < 0.9 else [1.0, 0.0, 0.0], bearing)
    x = aside / np.linalg.norm(aside)
    return np.stack([x, np.cross(bearing, x), bearing])
