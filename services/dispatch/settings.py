"""Settings of the dispatch service, from DISPATCH_* variables."""

from typing import Self

from pydantic import Field, PositiveFloat, model_validator
from pydantic_settings import SettingsConfigDict

from services.dispatch.core import Limits
from shared.settings import ServiceSettings


class DispatchSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        battery_low: share of a full charge; with less the robot goes home. 0: never.
        battery_resume: with this much again it goes on with its tasks.
        catch_up_s: a due time of a schedule that was missed, as nothing ran, still counts for so long.
        period_s: between two looks at the queue.
        query_timeout_s: for an answer of the map store or the planner.
    """

    model_config = SettingsConfigDict(env_prefix="DISPATCH_")

    battery_low: float = Field(default=0.2, ge=0.0, le=1.0)
    battery_resume: float = Field(default=0.8, ge=0.0, le=1.0)
    catch_up_s: float = Field(default=600.0, ge=0.0, le=86_400.0)
    period_s: PositiveFloat = 1.0
    query_timeout_s: PositiveFloat = 5.0

    @model_validator(mode="after")
    def _resumes_above_low(self) -> Self:
        if self.battery_resume < self.battery_low:
            raise ValueError(
                f"BATTERY_RESUME must be at least BATTERY_LOW ({self.battery_low}), got {self.battery_resume}"
            )
        return self

    def limits(self) -> Limits:
        """Those of the battery."""
        return Limits(self.battery_low, self.battery_resume)
