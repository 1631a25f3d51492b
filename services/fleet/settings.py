"""Settings of the fleet service, from FLEET_* variables."""

from pydantic import Field, PositiveFloat, PositiveInt
from pydantic_settings import SettingsConfigDict

from services.fleet.core import Limits
from shared.settings import ServiceSettings


class FleetSettings(ServiceSettings):
    """Read from the environment.

    Attributes:
        battery: share of a full charge; a robot with less gets no task. 0: whatever the charge.
        silent_s: what waits for a robot of which nothing is heard for so long is taken back.
        patience_s: likewise of one that is stopped, driven by hand or busy with something else.
        period_s: between two looks at the queue.
        map_period_s: a map that changes is read anew at most so often.
        query_timeout_s: for an answer of the map store.
        max_robots: further names are ignored.
    """

    model_config = SettingsConfigDict(env_prefix="FLEET_")

    battery: float = Field(default=0.3, ge=0.0, le=1.0)
    silent_s: float = Field(default=10.0, ge=0.0, le=3_600.0)
    patience_s: float = Field(default=60.0, ge=0.0, le=86_400.0)
    period_s: PositiveFloat = 1.0
    map_period_s: float = Field(default=10.0, ge=0.0, le=3_600.0)
    query_timeout_s: PositiveFloat = 5.0
    max_robots: PositiveInt = 64

    def limits(self) -> Limits:
        """What decides whether a robot gets a task and keeps it."""
        return Limits(self.battery, self.silent_s, self.patience_s)
