"""Settings of the drive service, from DRIVE_* variables."""

from typing import Literal

from pydantic_settings import SettingsConfigDict

from services.drive.core import DriveLimits
from services.drive.velocity import WheelLimits
from shared.settings import ServiceSettings

ProfileName = Literal["default", "thesis", "outdoor"]


class DriveSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        profile: default (indoor speeds, passing), thesis (indoor speeds, momentary), outdoor (fast, passing).
        seed: of the random weights of the momentary rule.
    """

    model_config = SettingsConfigDict(env_prefix="DRIVE_")

    profile: ProfileName = "default"
    seed: int = 0

    def limits(self) -> DriveLimits:
        """The limits of the chosen profile."""
        profiles = {
            "default": DriveLimits(),
            "thesis": DriveLimits(avoidance="momentary"),
            "outdoor": DriveLimits(wheels=WheelLimits(max_radps=10.0, min_radps=6.0), obstacle_range_m=1.5),
        }
        return profiles[self.profile]
