"""How this robot drives: speeds, sizes, its base, and how soon it stands."""

from typing import Literal

from pydantic import BaseModel, ConfigDict, PositiveFloat, PositiveInt, model_validator

from services.drive.bases.course import BaseLimits
from services.drive.passing import PassingLimits


class SpeedLimits(BaseModel):
    """Speeds at full speed; 10 and 6 rad/s on wheels of 0.08 m, section 6.2 of the thesis."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    max_mps: PositiveFloat = 0.8
    min_mps: PositiveFloat = 0.48

    @model_validator(mode="after")
    def _ordered(self) -> "SpeedLimits":
        if self.min_mps > self.max_mps:
            raise ValueError(f"min_mps must be at most max_mps, got {self.min_mps} > {self.max_mps}")
        return self


class DriveLimits(BaseModel):
    """How this robot drives.

    Attributes:
        avoidance: "passing" remembers the side it passes; "momentary" is the thesis's rule.
        obstacle_range_m: distance at which the momentary rule reacts (decision 0012, Q19: 0.5 m indoors).
        contact_s: so long after the robot saw it, and after the delay with which it sees, anything ahead may
            be touched at the earliest; chosen: at full speed 1 m of free way, a little more than the
            look-ahead, within which the way ahead changes.
        command_ttl_ms: the robot stops so long after the last velocity; a new one comes with the distances,
            every 100 ms: this bears the loss of one (tests/unit/services/drive/test_core.py).
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    avoidance: Literal["passing", "momentary"] = "passing"
    base: BaseLimits = BaseLimits()
    speeds: SpeedLimits = SpeedLimits()
    passing: PassingLimits = PassingLimits()
    obstacle_range_m: PositiveFloat = 0.5
    contact_s: PositiveFloat = 1.25
    command_ttl_ms: PositiveInt = 250
