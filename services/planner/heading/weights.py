"""Weight functions f of methods 2 and 4, by name (THESIS row 20; Q1: unit unstated, degrees by default).

Each maps an angle x = gain * angle to ln f(x): sums are formed from logarithms, so no exponential overflows.
"""

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat

from shared.geometry.angles import FloatArray

WeightName = Literal["exp", "one", "linear", "sigmoid"]
AngleUnit = Literal["deg", "rad"]


def _exp(x: FloatArray) -> FloatArray:
    return x


def _one(x: FloatArray) -> FloatArray:
    return np.zeros_like(x)


def _linear(x: FloatArray) -> FloatArray:
    """Logarithm of max(x, 0): only what moved towards the edge of the view counts."""
    return np.where(x > 0.0, np.log(np.where(x > 0.0, x, 1.0)), -np.inf)


def _sigmoid(x: FloatArray) -> FloatArray:
    return -np.logaddexp(0.0, -x)


LOG_WEIGHTS: dict[str, Callable[[FloatArray], FloatArray]] = {
    "exp": _exp,
    "one": _one,
    "linear": _linear,
    "sigmoid": _sigmoid,
}


class WeightSettings(BaseModel):
    """Weight function of methods 2 and 4.

    Attributes:
        name: key of LOG_WEIGHTS.
        gain: factor on the angle, per `unit`.
        unit: whether the angle is in degrees or radians before the gain.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    name: WeightName = "exp"
    gain: PositiveFloat = 1.0
    unit: AngleUnit = "deg"

    def log_weights(self, angle_rad: FloatArray) -> FloatArray:
        """Logarithm (M,) of the weights of angles (M,), radians."""
        angle = np.rad2deg(angle_rad) if self.unit == "deg" else angle_rad
        return np.asarray(LOG_WEIGHTS[self.name](self.gain * angle), dtype=np.float64)


UNWEIGHTED = WeightSettings(name="one")
WEIGHT_NAMES: tuple[str, ...] = get_args(WeightName)
