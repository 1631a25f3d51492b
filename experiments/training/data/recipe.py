"""What pairs training sees: how far apart, in what light, through what camera."""

from typing import Annotated, Self

from pydantic import Field, NonNegativeFloat, PositiveFloat, PositiveInt, field_validator

from experiments.training.recipe import Recipe

Percent = Annotated[int, Field(ge=1, le=100)]


class DataRecipe(Recipe):
    """How pairs are drawn and degraded.

    Attributes:
        seed: of every draw.
        width_px: of the panoramas, as in the running stack.
        apart_m: distances of positive pairs, evenly: what a robot compares, and twice what it reaches today.
        negatives: share of pairs of places that do not see each other, of equal rooms where there are any.
        tilt_rad: 1 sigma of pitch and roll of each picture: 3 degrees, as of a robot that rocks.
        height_m: of the cameras, and by how much (evenly, to each side) each end of a shard differs.
        illumination: most; each end of a shard has its own in half of the shards.
        furniture: share moved between the ends, in a third of the shards.
        exposure_stops: most, to each side.
        noise: most level of `simulator.disturbances.noise`.
        blur_px: most sigma; `smear_px`: most width of a turn during the exposure.
        jpeg: quality, from and to.
        seam: most difference in brightness of the halves of a camera with two lenses; `seam_px`: its step.
        disturbed: share of pictures that are degraded at all.
    """

    seed: int = Field(default=1, ge=0)
    width_px: PositiveInt = 1024
    apart_m: tuple[PositiveFloat, PositiveFloat] = (0.2, 6.0)
    negatives: float = Field(default=0.15, ge=0.0, le=1.0)
    tilt_rad: NonNegativeFloat = 0.052
    height_m: tuple[PositiveFloat, NonNegativeFloat] = (0.8, 0.05)
    illumination: float = Field(default=0.8, ge=0.0, le=1.0)
    furniture: float = Field(default=0.3, ge=0.0, le=1.0)
    exposure_stops: NonNegativeFloat = 1.0
    noise: float = Field(default=0.4, ge=0.0, le=1.0)
    blur_px: NonNegativeFloat = 1.2
    smear_px: NonNegativeFloat = 6.0
    jpeg: tuple[Percent, Percent] = (60, 95)
    seam: NonNegativeFloat = 0.08
    seam_px: NonNegativeFloat = 2.0
    disturbed: float = Field(default=0.7, ge=0.0, le=1.0)

    @field_validator("apart_m", "jpeg")
    @classmethod
    def _rises(cls, ends: tuple[float, float]) -> tuple[float, float]:
        if ends[0] > ends[1]:
            raise ValueError(f"from and to must rise, got {ends[0]} and {ends[1]}")
        return ends

    @classmethod
    def plain(cls, seed: int, apart_m: tuple[float, float]) -> Self:
        """Pictures as the simulated camera takes them, to judge on."""
        return cls(
            seed=seed, apart_m=apart_m, negatives=0.2, tilt_rad=0.0, height_m=(0.8, 0.0), illumination=0.0,
            furniture=0.0, disturbed=0.0, jpeg=(95, 95),
        )  # fmt: skip
