"""Settings of the feature service; importing them loads no image library."""

from dataclasses import replace
from typing import Literal, Self

from pydantic import Field, PositiveFloat, field_validator, model_validator
from pydantic_settings import SettingsConfigDict

from services.features.pipeline.interfaces import Profile, Runtime
from services.features.pipeline.named_pipelines import find_profile
from shared.access.credentials import credentials_in
from shared.settings import RobotNames, ServiceSettings


class FeaturesSettings(ServiceSettings):
    """Read from the environment, e.g. FEATURES_PIPELINE=thesis.

    Attributes:
        robots: whose frames and questions this process takes, as r1,r2; empty: those of `robot` alone.
        pipeline: a named profile or extractor/representation/matcher, see `named_pipelines`.
        tilting: the camera may lean: where level ones explain too little, any motion is tried.
        extractor: instead of `pipeline` where not empty.
        device: where networks run: cpu or cuda.
        threads: cores that OpenCV and networks may use.
        frames_kept: newest frames whose features a MATCH can name by number.
        map_timeout_s: longest wait for the map store.
        thumbnail_width_px: width of the picture sent along, half as high: for people, for look-alikes, and
            kept with nodes to compare ordinary photos with.
        thumbnail_quality: JPEG quality of it, percent.
    """

    model_config = SettingsConfigDict(env_prefix="FEATURES_")

    robots: RobotNames = ()
    pipeline: str = "sift"
    extractor: str = ""
    tilting: bool = True
    device: Literal["cpu", "cuda"] = "cpu"
    threads: int = Field(default=2, ge=1, le=64)
    frames_kept: int = Field(default=8, ge=1, le=1024)
    map_timeout_s: PositiveFloat = 5.0
    thumbnail_width_px: int = Field(default=800, ge=16, le=1024)
    thumbnail_quality: int = Field(default=75, ge=1, le=100)

    def profile(self) -> Profile:
        """The pipeline's profile with what these settings replace."""
        return replace(find_profile(self.extractor or self.pipeline), tilting=self.tilting)

    def runtime(self) -> Runtime:
        """Where networks run."""
        return Runtime(self.device)

    @property
    def served(self) -> tuple[str, ...]:
        """Names of the robots this process works for."""
        return self.robots or (self.robot,)

    @model_validator(mode="after")
    def _may_serve(self) -> Self:
        if len(self.robots) > 1 and credentials_in(self.certs) is not None:
            raise ValueError(
                f"FEATURES_ROBOTS names {len(self.robots)} robots and a certificate is for one: on the "
                "secured bus run a feature service for each robot"
            )
        return self

    @field_validator("pipeline", "extractor")
    @classmethod
    def _known(cls, name: str) -> str:
        if name:
            find_profile(name)
        return name
