"""Settings of the drive service, from DRIVE_* variables."""

from pathlib import Path
from typing import Literal

from pydantic_settings import SettingsConfigDict

from services.drive.core import DriveLimits, WheelLimits
from services.drive.passing import PassingLimits
from shared.settings import ServiceSettings

ProfileName = Literal["default", "outdoor", "thesis", "thesis_outdoor"]

OUTDOOR_WHEELS = WheelLimits(max_radps=10.0, min_radps=6.0)  # section 6.2 of the thesis
# chosen: at twice the speed twice the look-ahead, and 4 cm more to spare beside the robot
OUTDOOR_PASSING = PassingLimits(radius_m=0.33, radius_slow_m=0.29, lookahead_m=0.9, lookahead_min_m=0.15)


class DriveSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        profile: default and outdoor pass obstacles with memory, thesis and thesis_outdoor by the momentary
            rule; the outdoor ones drive at the thesis's outdoor speeds and look further ahead.
        seed: of the random weights of the momentary rule.
        state_dir: where an emergency stop is kept across restarts, the one thing this service remembers.
    """

    model_config = SettingsConfigDict(env_prefix="DRIVE_")

    profile: ProfileName = "default"
    seed: int = 0
    state_dir: Path = Path("data/drive-state")

    def limits(self) -> DriveLimits:
        """The limits of the chosen profile."""
        profiles = {
            "default": DriveLimits(),
            "outdoor": DriveLimits(
                wheels=OUTDOOR_WHEELS, passing=OUTDOOR_PASSING, full_speed_clearance_m=1.2
            ),
            "thesis": DriveLimits(avoidance="momentary"),
            "thesis_outdoor": DriveLimits(avoidance="momentary", wheels=OUTDOOR_WHEELS, obstacle_range_m=1.5),
        }
        return profiles[self.profile]
