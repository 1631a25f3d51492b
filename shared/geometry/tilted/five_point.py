"""Essential matrices of two views of any tilt from five matches each, and their poses.

With rotation R and unit travel t, E = [t]x R, matches fulfil b^T E b_t = 0. Five of them give E (Stewenius,
Engels and Nister 2006), batched: E = x E1 + y E2 + z E3 + E4 spans the null space of the five equations; the
ten cubics det E = 0 and 2 E E^T E - tr(E E^T) E = 0 reduce to the eigenvectors of a 10 x 10 action matrix.
"""

from functools import cache
from itertools import combinations_with_replacement, product

import numpy as np

from shared.geometry.sphere import FloatArray
from shared.geometry.tilted.poses import Poses

SINGULAR = 1e-18
"""Determinant below which five matches fix no matrix; chosen: above the rounding of ten factors below 1."""
REAL = 1e-8
"""Imaginary part of an eigenvalue that counts as rounding: the root of double precision."""
TINY = 1e-12
"""Keeps a division from zero; far below any bearing that a keypoint resolves."""

# Monomials of degree three in (x, y, z, 1); the last ten, all of degree below three, are the basis of the
# quotient.
_CUBICS = [m for m in combinations_with_replacement(range(4), 3) if 3 not in m]
_LOWER = [m for m in combinations_with_replacement(range(4), 3) if 3 in m]


def five_point(current: FloatArray, target: FloatArray) -> FloatArray:
    """Essential matrices of H samples of five matches.

    Args:
        current: (H, 5, 3) unit bearings, current frame.
        target: (H, 5, 3) unit bearings, target frame.

    Returns:
        (M, 3, 3) real solutions of all samples together, unit Frobenius norm, M <= 10 H.
    """
    rows = np.einsum("hki,hkj->hkij", current, target).reshape(len(current), 5, 9)
    q, _ = np.linalg.qr(np.swapaxes(rows, 1, 2), mode="complete")
    basis = np.swapaxes(q[:, :, 5:], 1, 2).reshape(-1, 4, 3, 3)
    constraints = _constraints(basis)
    left, right = constraints[:, :, :10], constraints[:, :, 10:]
    solvable = np.abs(np.linalg.det(left)) > SINGULAR
    if not solvable.any():
        return np.empty((0, 3, 3))
    action = _action(np.linalg.solve(left[solvable], right[solvable]))
    values, vectors = np.linalg.eig(action)
    x, y, z, one = (
        vectors[:, _LOWER.index(monomial), :] for monomial in ((0, 3, 3), (1, 3, 3), (2, 3, 3), (3, 3, 3))
    )
    real = (np.abs(values.imag) < REAL) & (np.abs(one) > TINY)
    safe = np.where(real, one, 1.0)
    coefficients = np.stack([x / safe, y / safe, z / safe, np.ones_like(safe)], axis=-1).real
    essential = (coefficients @ basis[solvable].reshape(-1, 4, 9))[real].reshape(-1, 3, 3)
    return np.asarray(essential / np.linalg.norm(essential, axis=(1, 2), keepdims=True), dtype=np.float64)


def _constraints(basis: FloatArray) -> FloatArray:
    """Coefficients (H, 10, 20) of the ten cubics over the monomials _CUBICS + _LOWER."""
    count = len(basis)
    flat = basis.reshape(count, 12, 3)
    outer = (flat @ np.swapaxes(flat, 1, 2)).reshape(count, 4, 3, 4, 3).transpose(0, 1, 3, 2, 4)
    trace = np.trace(outer, axis1=3, axis2=4)[..., None, None]
    by_columns = basis.transpose(0, 2, 1, 3).reshape(count, 3, 12)
    cubic = (2.0 * outer - trace * np.eye(3)).reshape(count, 48, 3) @ by_columns
    cubic = cubic.reshape(count, 16, 3, 4, 3).transpose(0, 2, 4, 1, 3).reshape(count, 9, 64)
    minors = np.cross(basis[:, :, None, 1, :], basis[:, None, :, 2, :]).reshape(count, 16, 3)
    determinant = basis[:, :, 0, :] @ np.swapaxes(minors, 1, 2)
    return np.concatenate([cubic, determinant.reshape(count, 1, 64)], axis=1) @ _collect()


@cache
def _collect() -> FloatArray:
    """(64, 20) matrix that adds up the coefficients of equal monomials; read only."""
    table = np.zeros((64, 20))
    monomials = _CUBICS + _LOWER
    for row, triple in enumerate(product(range(4), repeat=3)):
        table[row, monomials.index(_sorted(triple))] = 1.0
    table.flags.writeable = False
    return table


def _action(reduced: FloatArray) -> FloatArray:
    """Matrix (H, 10, 10) of the multiplication by x on the basis _LOWER, from cubic = -reduced @ lower."""
    action = np.zeros_like(reduced)
    for row, monomial in enumerate(_LOWER):
        raised = list(monomial)
        raised.remove(3)
        product_x = _sorted((*raised, 0))
        if product_x in _CUBICS:
            action[:, row, :] = -reduced[:, _CUBICS.index(product_x), :]
        else:
            action[:, row, _LOWER.index(product_x)] = 1.0
    return action


def _sorted(triple: tuple[int, ...]) -> tuple[int, int, int]:
    a, b, c = sorted(triple)
    return a, b, c


def poses_of(essentials: FloatArray) -> Poses:
    """One of the four poses of each of (M, 3, 3) essential matrices (Hartley and Zisserman, 9.6.2).

    The others are its opposites, see Poses.opposite.
    """
    u, _, vt = np.linalg.svd(essentials)
    rotation = u @ np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) @ vt
    return Poses(rotation * np.linalg.det(rotation)[:, None, None], u[:, :, 2])
