"""Least squares over differences of node values along edges, the first node held. Pure."""

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IndexArray = npt.NDArray[np.intp]

TINY = 1e-9
"""Added to the diagonal, so that a node that no weight holds stays where it is."""


class Differences:
    """Equations axis . (x_b - x_a) = measured, for values of D numbers a node.

    Args:
        ends: (M, 2) nodes a and b.
        axes: (M, D) what is measured of the difference.
        count: number of nodes.
    """

    def __init__(self, ends: IndexArray, axes: FloatArray, count: int) -> None:
        self._a, self._b, self._axes, self._count = ends[:, 0], ends[:, 1], axes, count

    def of(self, values: FloatArray) -> FloatArray:
        """(M,) left sides for values (N, D)."""
        return np.asarray(((values[self._b] - values[self._a]) * self._axes).sum(axis=1))

    def step(self, weight: FloatArray, residual: FloatArray) -> FloatArray:
        """(N, D) change of the values that meets the residuals (M,) best; the first node does not move."""
        pull = (weight * residual)[:, None] * self._axes
        right = np.zeros((self._count, self._axes.shape[1]))
        np.add.at(right, self._b, pull)
        np.add.at(right, self._a, -pull)
        return self._solve(weight, right.reshape(-1, 1)).reshape(right.shape)

    def covariance(self, weight: FloatArray, rows: IndexArray) -> FloatArray:
        """(K, D, D) covariances of the values of some nodes relative to the first."""
        size = self._axes.shape[1]
        pick = (size * rows[:, None] + np.arange(size)).ravel()
        columns = np.zeros((self._count * size, len(pick)))
        columns[pick, np.arange(len(pick))] = 1.0
        inverse = self._solve(weight, columns)[pick]
        blocks = [inverse[k : k + size, k : k + size] for k in range(0, len(pick), size)]
        return np.array(blocks).reshape(-1, size, size)

    def _solve(self, weight: FloatArray, right: FloatArray) -> FloatArray:
        size = self._axes.shape[1]
        blocks = weight[:, None, None] * self._axes[:, :, None] * self._axes[:, None, :]
        normal = np.zeros((self._count, self._count, size, size))
        for first, second, sign in (
            (self._a, self._a, 1.0),
            (self._b, self._b, 1.0),
            (self._a, self._b, -1.0),
            (self._b, self._a, -1.0),
        ):
            np.add.at(normal, (first, second), sign * blocks)
        square = normal.transpose(0, 2, 1, 3).reshape(self._count * size, self._count * size)
        result = np.zeros_like(right)
        free = square[size:, size:] + TINY * np.eye(len(square) - size)
        result[size:] = np.linalg.solve(free, right[size:])
        return result
