"""Kinds of values that world files are made of, and the model that all their parts share."""

from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field

MOST_M = 500.0  # of any coordinate


def _interval(value: tuple[float, float]) -> tuple[float, float]:
    if not value[0] < value[1]:
        raise ValueError(f"must be [low, high] with low < high, got [{value[0]}, {value[1]}]")
    return value


Metres = Annotated[float, Field(ge=-MOST_M, le=MOST_M)]
Degrees = Annotated[float, Field(ge=-3600.0, le=3600.0)]
Height = Annotated[float, Field(gt=0.0, le=30.0)]
Name = Annotated[str, Field(min_length=1, max_length=80)]
Interval = Annotated[tuple[Metres, Metres], AfterValidator(_interval)]
Seed = Annotated[int, Field(ge=0, lt=2**63)]
Channel = Annotated[int, Field(ge=0, le=255)]


class FileModel(BaseModel):
    """A part of a world file: never changed, and nothing in it that is not known."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)
