"""The base of every message on the bus."""

from typing import Annotated, ClassVar

from pydantic import BaseModel, ConfigDict, Field

Name = Annotated[str, Field(pattern=r"^[a-z0-9_-]{1,64}$")]
"""Names of robots, maps, missions and services: the same rule in REST and on the bus."""

Bearing = Annotated[float, Field(ge=-6.3, le=6.3)]
"""An angle in radians, robot or camera frame: 0 ahead, counter-clockwise positive."""

SECTORS = 12
"""Directions per robot and per node, 30 degrees apart, sector 0 ahead, counter-clockwise."""


class Part(BaseModel):
    """A piece of a message: frozen, finite numbers only, unknown fields of newer versions ignored."""

    model_config = ConfigDict(frozen=True, extra="ignore", allow_inf_nan=False, arbitrary_types_allowed=True)


class Message(Part):
    """A whole message. `SCHEMA` names its kind and version and travels with it.

    `MAX_ITEMS` bounds the values in all its lists and maps together: eight megabytes of empty maps would
    otherwise take half a gigabyte to decode.

    Attributes:
        seq: number of the frame this message belongs to, or a counter of the sender.
        stamp_ns: capture time of that frame, nanoseconds since the Unix epoch.
    """

    SCHEMA: ClassVar[str]
    MAX_ITEMS: ClassVar[int] = 2_000

    seq: int = Field(default=0, ge=0, lt=2**63)
    stamp_ns: int = Field(default=0, ge=0, lt=2**63)
