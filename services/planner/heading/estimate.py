"""What a heading method returns, and sums of weighted directions that cannot overflow."""

from dataclasses import dataclass

import numpy as np

from shared.geometry.sphere import FloatArray, wrap_rad


@dataclass(frozen=True)
class HeadingEstimate:
    """Direction to go.

    Attributes:
        heading_rad: current frame, [-pi, pi); None where the matches name no direction.
        strength: [0, 1]: for methods 1 to 6 the length of the resultant over the sum of its parts' lengths
            (1: all agree); for the epipolar method its confidence.
    """

    heading_rad: float | None
    strength: float


NO_HEADING = HeadingEstimate(None, 0.0)


@dataclass(frozen=True, eq=False)
class Resultant:
    """The heading vector h, equations (2.7), (2.10), (2.16) and (2.18), as exp(log_scale) times `vector`.

    Attributes:
        vector: (2,) sum of scaled directions.
        total: sum of their lengths, on the same scale.
        log_scale: natural logarithm of the common factor; exp of degrees would overflow without it.
    """

    vector: FloatArray
    total: float
    log_scale: float

    def __add__(self, other: "Resultant") -> "Resultant":
        """Raw vector sum, on the larger of the two scales."""
        scale = max(self.log_scale, other.log_scale)
        a, b = np.exp(self.log_scale - scale), np.exp(other.log_scale - scale)
        return Resultant(self.vector * a + other.vector * b, float(self.total * a + other.total * b), scale)

    def unit(self) -> "Resultant":
        """The same direction with length one; a vector without direction stays zero."""
        length = float(np.hypot(*self.vector))
        if length <= 1e-12 * max(self.total, 1e-300):
            return Resultant(np.zeros(2), 0.0, 0.0)
        return Resultant(self.vector / length, 1.0, 0.0)

    def estimate(self) -> HeadingEstimate:
        """Heading and strength; no heading where the parts cancel or there are none."""
        length = float(np.hypot(*self.vector))
        if length <= 1e-12 * max(self.total, 1e-300):
            return NO_HEADING
        heading = float(wrap_rad(np.arctan2(self.vector[1], self.vector[0])))
        return HeadingEstimate(heading, min(length / self.total, 1.0))


def weighted_sum(directions: FloatArray, log_weights: FloatArray) -> Resultant:
    """Sum of exp(log_weights) times directions.

    Args:
        directions: (M, 2) vectors of length zero to one.
        log_weights: (M,) natural logarithms of the weights; -inf is a weight of zero.
    """
    lengths = np.hypot(directions[:, 0], directions[:, 1])
    used = (lengths > 0.0) & (log_weights > -np.inf)
    if not used.any():
        return Resultant(np.zeros(2), 0.0, 0.0)
    scale = float(np.max(log_weights[used]))
    weights = np.exp(log_weights[used] - scale)
    return Resultant(weights @ directions[used], float(weights @ lengths[used]), scale)
