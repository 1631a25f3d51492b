"""How strongly each disturbance acts: one level each, 0 (off) to 1, its text form, and the seeded draws."""

from typing import Any, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator

HOW = 'write them as "fog=0.5,noise=0.3"'


UNSEEN = frozenset({"latency", "drops", "slip", "deadband"})
"""Disturbances that change no single picture."""


class Disturbances(BaseModel):
    """Levels from 0, nothing at all, to 1.

    Attributes:
        illumination: time of day, from noon (0) over dusk (0.5) to lamps only (1).
        fog: haze that takes contrast with distance.
        rain: falling streaks, drops on the lens and a little haze.
        noise: shot and read noise of the camera.
        blur: exposure time while the robot moves.
        exposure: slow swings of brightness with clipping.
        people: walkers and carts on closed paths.
        furniture: share of movable furniture that was moved or taken away.
        tilt: inclination of the camera, constant and swaying, up to 5 degrees.
        rocking: the robot swings on its legs: pitch and roll of 3 degrees each (rms) while it drives.
        mount: the camera is mounted askew, constantly, by up to 10 degrees.
        latency: frames arrive up to 0.6 s after their exposure.
        drops: up to half of the frames never arrive.
        slip: wheels slip: the robot goes and turns up to 30 % less than they roll.
        deadband: wheels that should roll more slowly than up to 0.1 m/s stand still.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    illumination: float = Field(default=0.0, ge=0.0, le=1.0)
    fog: float = Field(default=0.0, ge=0.0, le=1.0)
    rain: float = Field(default=0.0, ge=0.0, le=1.0)
    noise: float = Field(default=0.0, ge=0.0, le=1.0)
    blur: float = Field(default=0.0, ge=0.0, le=1.0)
    exposure: float = Field(default=0.0, ge=0.0, le=1.0)
    people: float = Field(default=0.0, ge=0.0, le=1.0)
    furniture: float = Field(default=0.0, ge=0.0, le=1.0)
    tilt: float = Field(default=0.0, ge=0.0, le=1.0)
    rocking: float = Field(default=0.0, ge=0.0, le=1.0)
    mount: float = Field(default=0.0, ge=0.0, le=1.0)
    latency: float = Field(default=0.0, ge=0.0, le=1.0)
    drops: float = Field(default=0.0, ge=0.0, le=1.0)
    slip: float = Field(default=0.0, ge=0.0, le=1.0)
    deadband: float = Field(default=0.0, ge=0.0, le=1.0)

    @model_validator(mode="before")
    @classmethod
    def _from_text(cls, value: Any) -> Any:
        return _levels(value) if isinstance(value, str) else value

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read "fog=0.5,noise=0.3"; an empty text is no disturbance.

        Raises:
            ValueError: an unknown name, a name given twice, or a level that is no number from 0 to 1.
        """
        try:
            return cls.model_validate(text)
        except ValidationError as error:
            faults = (f"{'.'.join(map(str, e['loc'])) or 'disturbance'}: {e['msg']}" for e in error.errors())
            raise ValueError("; ".join(faults)) from error

    def text(self) -> str:
        """The text form; levels of 0 are left out."""
        return ",".join(f"{name}={level:g}" for name, level in self if level)


def generator(seed: int, purpose: str, *numbers: float) -> np.random.Generator:
    """The same arguments give the same draws, whatever was drawn before; numbers count in millionths."""
    return np.random.default_rng(
        [seed, *purpose.encode(), *(round(number * 1e6) % 2**32 for number in numbers)]
    )


def _levels(text: str) -> dict[str, float]:
    levels: dict[str, float] = {}
    for entry in filter(None, (part.strip() for part in text.split(","))):
        name, _, number = (part.strip() for part in entry.partition("="))
        if name not in Disturbances.model_fields:
            raise ValueError(f"no disturbance {name!r}: choose from {', '.join(Disturbances.model_fields)}")
        if name in levels:
            raise ValueError(f"{name} is given twice; give each disturbance once")
        try:
            levels[name] = float(number)
        except ValueError:
            raise ValueError(f"{name} needs a level from 0 to 1, got {number!r}; {HOW}") from None
        if not 0.0 <= levels[name] <= 1.0:
            raise ValueError(f"{name} must be a level from 0 to 1, got {number}; {HOW}")
    return levels
