"""Settings of the planner service, from PLANNER_* variables."""

from pathlib import Path

from pydantic import NonNegativeInt, PositiveFloat, PositiveInt, field_validator
from pydantic_settings import SettingsConfigDict

from services.planner.heading.methods import MethodName
from services.planner.profile_file import profile_of_file
from services.planner.profiles import Profile, profile_named
from shared.settings import OptionalPath, ServiceSettings


class PlannerSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        profile: name of the thresholds and rules.
        profile_file: takes the place of `profile`: a file of `topnav calibrate --write`.
        heading_method: replaces the profile's: epipolar, histogram or 1 to 6.
        edge_window: replaces the profile's: how many of the newest nodes may get an edge to a new one.
        missions_folder: files with further kinds of mission, see `services.planner.mission_kinds`.
        heading_ttl_ms: how long the drive service may follow one heading in real time.
        query_timeout_s: for a match; map_timeout_s: for a map transaction.
    """

    model_config = SettingsConfigDict(env_prefix="PLANNER_")

    profile: str = "default"
    profile_file: OptionalPath = None
    heading_method: MethodName | None = None
    edge_window: NonNegativeInt | None = None
    missions_folder: OptionalPath = None
    heading_ttl_ms: PositiveInt = 350
    query_timeout_s: PositiveFloat = 5.0
    map_timeout_s: PositiveFloat = 5.0

    def rules(self) -> Profile:
        """The profile with what these settings replace."""
        given = {"heading_method": self.heading_method, "edge_window": self.edge_window}
        update = {name: value for name, value in given.items() if value is not None}
        named = profile_of_file(self.profile_file) if self.profile_file else profile_named(self.profile)
        return named.replaced(**update)

    @field_validator("profile_file")
    @classmethod
    def _readable(cls, value: Path | None) -> Path | None:
        if value is not None:
            profile_of_file(value)
        return value

    @field_validator("missions_folder")
    @classmethod
    def _is_folder(cls, value: Path | None) -> Path | None:
        if value is not None and not value.is_dir():
            raise ValueError(f"missions_folder must be a folder, got {value}")
        return value

    @field_validator("profile")
    @classmethod
    def _known(cls, value: str) -> str:
        return profile_named(value).name
