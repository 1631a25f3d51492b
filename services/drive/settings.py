"""Settings of the drive service, from DRIVE_* variables."""

from pathlib import Path
from typing import Literal

from pydantic_settings import SettingsConfigDict

from services.drive.core import DriveLimits, WheelLimits
from shared.settings import ServiceSettings

ProfileName = Literal["default", "thesis", "thesis_outdoor"]

INDOOR_WHEELS = WheelLimits(max_radps=5.0, min_radps=3.0)  # section 6.2 of the thesis


class DriveSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        profile: default passes obstacles with memory, thesis and thesis_outdoor by the momentary rule, at the
            thesis's speeds indoors and outdoors.
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
            "thesis": DriveLimits(avoidance="momentary", wheels=INDOOR_WHEELS),
            "thesis_outdoor": DriveLimits(avoidance="momentary", obstacle_range_m=1.5),
        }
        return profiles[self.profile]
