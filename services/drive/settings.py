"""Settings of the drive service, from DRIVE_* variables."""

from pathlib import Path
from typing import Literal

from pydantic import PositiveFloat
from pydantic_settings import SettingsConfigDict

from services.drive.bases.course import BaseLimits, BaseName
from services.drive.limits import DriveLimits, SpeedLimits
from shared.settings import ServiceSettings

ProfileName = Literal["default", "thesis", "thesis_outdoor"]

INDOOR = SpeedLimits(max_mps=0.4, min_mps=0.24)  # 5 and 3 rad/s, section 6.2 of the thesis


class DriveSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        profile: default passes obstacles with memory, thesis and thesis_outdoor by the momentary rule, at the
            thesis's speeds indoors and outdoors.
        base: what the robot rolls on.
        turn_radps: fastest turn of a base that turns.
        turning_radius_m: least turning radius of a base that steers as a car does.
        seed: of the random weights of the momentary rule.
        state_dir: where an emergency stop is kept across restarts, the one thing this service remembers.
    """

    model_config = SettingsConfigDict(env_prefix="DRIVE_")

    profile: ProfileName = "default"
    base: BaseName = "holonomic"
    turn_radps: PositiveFloat = BaseLimits().turn_radps
    turning_radius_m: PositiveFloat = BaseLimits().radius_m
    seed: int = 0
    state_dir: Path = Path("data/drive-state")

    def limits(self) -> DriveLimits:
        """The limits of the chosen profile and base."""
        base = BaseLimits(name=self.base, turn_radps=self.turn_radps, radius_m=self.turning_radius_m)
        profiles = {
            "default": DriveLimits(base=base),
            "thesis": DriveLimits(base=base, avoidance="momentary", speeds=INDOOR),
            "thesis_outdoor": DriveLimits(base=base, avoidance="momentary", obstacle_range_m=1.0),
        }
        return profiles[self.profile]
