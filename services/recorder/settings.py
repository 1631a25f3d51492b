"""Settings of the recorder, from RECORDER_*."""

from pathlib import Path

from pydantic import field_validator
from pydantic_settings import SettingsConfigDict

from services.recorder.channels import topics_named
from shared.settings import ServiceSettings


class RecorderSettings(ServiceSettings):
    """What is recorded where.

    Attributes:
        file: MCAP file to write; it must not exist.
        without: names of topics to leave out, as "frame,features".
    """

    model_config = SettingsConfigDict(env_prefix="RECORDER_", frozen=True, extra="forbid")

    file: Path = Path("recording.mcap")
    without: str = ""

    @field_validator("without")
    @classmethod
    def _known_topics(cls, names: str) -> str:
        topics_named(names)
        return names
