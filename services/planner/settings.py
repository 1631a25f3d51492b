"""Settings of the planner service, from PLANNER_* variables."""

from pydantic import PositiveFloat, PositiveInt, field_validator
from pydantic_settings import SettingsConfigDict

from services.planner.profiles import profile_named
from shared.settings import ServiceSettings


class PlannerSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        profile: name of the thresholds and rules.
        heading_ttl_ms: how long the drive service may follow one heading in real time.
        query_timeout_s: for a match; map_timeout_s: for a map transaction.
    """

    model_config = SettingsConfigDict(env_prefix="PLANNER_")

    profile: str = "default"
    heading_ttl_ms: PositiveInt = 350
    query_timeout_s: PositiveFloat = 5.0
    map_timeout_s: PositiveFloat = 5.0

    @field_validator("profile")
    @classmethod
    def _known(cls, value: str) -> str:
        return profile_named(value).name
