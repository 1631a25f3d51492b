"""Settings of the feature service; importing them loads no image library."""

from dataclasses import replace
from typing import Literal

from pydantic import Field, PositiveFloat, field_validator
from pydantic_settings import SettingsConfigDict

from services.features.pipelines import Profile, find_profile
from services.features.registry import Runtime
from shared.settings import ServiceSettings


class FeaturesSettings(ServiceSettings):
    """Read from the environment, e.g. FEATURES_PIPELINE=thesis.

    Attributes:
        pipeline: a named profile or extractor/representation/matcher, see `pipelines`.
        uneven_ground: verify by any motion of the camera where the plane explains too little.
        extractor: in place of `pipeline` where not empty.
        device: where networks run: cpu or cuda.
        threads: cores OpenCV may use.
        frames_kept: newest frames whose features a MATCH can name by number.
        map_timeout_s: longest wait for the map store.
        thumbnail_width_px: width of the picture sent along for people; half as high.
        thumbnail_quality: JPEG quality of it, percent.
    """

    model_config = SettingsConfigDict(env_prefix="FEATURES_")

    pipeline: str = "sift"
    extractor: str = ""
    uneven_ground: bool = False
    device: Literal["cpu", "cuda"] = "cpu"
    threads: int = Field(default=2, ge=1, le=64)
    frames_kept: int = Field(default=8, ge=1, le=1024)
    map_timeout_s: PositiveFloat = 5.0
    thumbnail_width_px: int = Field(default=320, ge=16, le=1024)
    thumbnail_quality: int = Field(default=70, ge=1, le=100)

    def profile(self) -> Profile:
        """The pipeline's profile with what these settings replace."""
        return replace(find_profile(self.extractor or self.pipeline), uneven_ground=self.uneven_ground)

    def runtime(self) -> Runtime:
        """Where networks run."""
        return Runtime(self.device)

    @field_validator("pipeline", "extractor")
    @classmethod
    def _known(cls, name: str) -> str:
        if name:
            find_profile(name)
        return name
