"""Settings of the sign service, from SIGNS_* variables."""

from pydantic import Field, PositiveFloat
from pydantic_settings import SettingsConfigDict

from shared.settings import ServiceSettings


class SignsSettings(ServiceSettings):
    """Read from the environment, e.g. SIGNS_THREADS=2.

    Attributes:
        threads: cores that reading may use.
        least_confidence: of a reading that counts; of what is no text it was 0.93 at most, of door signs
            at up to 2 m 0.995 at the median.
        frames_kept: newest frames among which that of a new node is looked for.
        nodes_waiting: nodes that wait to be read, two frames each; above that the oldest is left out.
        map_timeout_s: longest wait for the map store.
    """

    model_config = SettingsConfigDict(env_prefix="SIGNS_")

    threads: int = Field(default=1, ge=1, le=64)
    least_confidence: float = Field(default=0.97, ge=0.5, le=1.0)
    frames_kept: int = Field(default=12, ge=2, le=256)
    nodes_waiting: int = Field(default=100, ge=1, le=10_000)
    map_timeout_s: PositiveFloat = 5.0
