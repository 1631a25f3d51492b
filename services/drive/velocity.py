"""Velocity law of the thesis, section 6.2: slower near the via point."""

from pydantic import BaseModel, ConfigDict, PositiveFloat, model_validator


class WheelLimits(BaseModel):
    """Wheel speeds of a profile; the thesis uses 10/6 rad/s outdoors and 5/3 rad/s indoors."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    max_radps: PositiveFloat = 5.0
    min_radps: PositiveFloat = 3.0

    @model_validator(mode="after")
    def _ordered(self) -> "WheelLimits":
        if self.min_radps > self.max_radps:
            raise ValueError(f"min_radps must be at most max_radps, got {self.min_radps} > {self.max_radps}")
        return self


def velocity_gain(s_cv: int, s_slow: int, s_max: int) -> float:
    """Gain K_v of equation 6.5, simplified: 1 - (S - S_slow) / S_max above S_slow.

    With the thesis's S_slow = 90 and S_max = 150: K(90) = 1, K(110) = 0.867, K(150) = 0.6.
    """
    if s_cv <= s_slow:
        return 1.0
    return max(0.0, 1.0 - (s_cv - s_slow) / s_max)


def wheel_speed(s_cv: int, s_slow: int, s_max: int, speed_fraction: float, limits: WheelLimits) -> float:
    """Wheel speed in rad/s, equation 6.6, then limited by the planner's `speed_fraction`."""
    speed_radps = max(limits.min_radps, velocity_gain(s_cv, s_slow, s_max) * limits.max_radps)
    return speed_radps * speed_fraction
