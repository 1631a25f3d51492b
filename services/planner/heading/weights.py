"""Weight functions f of methods 2 and 4, by name (THESIS rows 20, 101; Q1: unit unstated, degrees here).

Each maps angles and a gain to ln f: sums are formed from logarithms, so no exponential overflows.
"""

from collections.abc import Callable
from typing import Literal, get_args

import numpy as np
from pydantic import BaseModel, ConfigDict, PositiveFloat

from shared.geometry.sphere import FloatArray

WeightName = Literal["exp", "one", "power", "sigmoid", "rank"]
AngleUnit = Literal["deg", "rad"]


def _exp(angle: FloatArray, gain: float) -> FloatArray:
    return gain * angle


def _one(angle: FloatArray, _gain: float) -> FloatArray:
    return np.zeros_like(angle)


def _power(angle: FloatArray, gain: float) -> FloatArray:
    """max(angle, 0)^gain: only what moved towards the edge of the view counts."""
    return np.where(angle > 0.0, gain * np.log(np.where(angle > 0.0, angle, 1.0)), -np.inf)


def _sigmoid(angle: FloatArray, gain: float) -> FloatArray:
    return -np.logaddexp(0.0, -gain * angle)


def _rank(angle: FloatArray, gain: float) -> FloatArray:
    """(place among all, as a share)^gain; equal angles share a place. Free of the angles' size."""
    _, inverse, counts = np.unique(angle, return_inverse=True, return_counts=True)
    place = np.cumsum(counts) - (counts - 1) / 2.0
    return np.asarray(gain * np.log(place[inverse] / max(len(angle), 1)))


LOG_WEIGHTS: dict[str, Callable[[FloatArray, float], FloatArray]] = {
    "exp": _exp,
    "one": _one,
    "power": _power,
    "sigmoid": _sigmoid,
    "rank": _rank,
}


class WeightSettings(BaseModel):
    """Weight function of methods 2 and 4.

    Attributes:
        name: key of LOG_WEIGHTS.
        gain: factor on the angle, per `unit`; exponent of 'power' and 'rank'.
        unit: whether the angle is in degrees or radians before the gain.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")
    name: WeightName = "exp"
    gain: PositiveFloat = 1.0
    unit: AngleUnit = "deg"

    def log_weights(self, angle_rad: FloatArray) -> FloatArray:
        """Logarithm (M,) of the weights of angles (M,), radians."""
        angle = np.rad2deg(angle_rad) if self.unit == "deg" else angle_rad
        return np.asarray(LOG_WEIGHTS[self.name](angle, self.gain), dtype=np.float64)


UNWEIGHTED = WeightSettings(name="one")
WEIGHT_NAMES: tuple[str, ...] = get_args(WeightName)
