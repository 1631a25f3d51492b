"""Settings of the live view, from FOXGLOVE_LIVE_*; Foxglove's own programs read FOXGLOVE_*."""

from pydantic import Field, field_validator
from pydantic_settings import SettingsConfigDict

from services.recorder.channels import topics_named
from shared.settings import ServiceSettings


class LiveSettings(ServiceSettings):
    """Where Foxglove connects, and what it is not shown.

    Attributes:
        host: address to listen at. Whoever reaches it sees all pictures: no password is asked.
        port: TCP port, 8765 is the one that Foxglove proposes.
        without: names of topics to leave out, as "features,imu". The true pose is for evaluations.
    """

    model_config = SettingsConfigDict(env_prefix="FOXGLOVE_LIVE_", frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    port: int = Field(default=8765, ge=1, le=65535)
    without: str = "truth"

    @field_validator("without")
    @classmethod
    def _known_topics(cls, names: str) -> str:
        topics_named(names)
        return names
