"""Settings of the planner service, from PLANNER_* variables."""

from pydantic import PositiveFloat, PositiveInt, field_validator
from pydantic_settings import SettingsConfigDict

from services.planner.heading.registry import MethodName
from services.planner.profiles import Profile, profile_named
from shared.settings import ServiceSettings


class PlannerSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        profile: name of the thresholds and rules.
        heading_method: replaces the profile's: epipolar, histogram or 1 to 6.
        heading_ttl_ms: how long the drive service may follow one heading in real time.
        query_timeout_s: for a match; map_timeout_s: for a map transaction.
    """

    model_config = SettingsConfigDict(env_prefix="PLANNER_")

    profile: str = "default"
    heading_method: MethodName | None = None
    heading_ttl_ms: PositiveInt = 350
    query_timeout_s: PositiveFloat = 5.0
    map_timeout_s: PositiveFloat = 5.0

    def rules(self) -> Profile:
        """The profile with what these settings replace."""
        profile = profile_named(self.profile)
        if self.heading_method is None:
            return profile
        return profile.model_copy(update={"heading_method": self.heading_method})

    @field_validator("profile")
    @classmethod
    def _known(cls, value: str) -> str:
        return profile_named(value).name
