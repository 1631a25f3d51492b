"""What is known of a tour, as people write it: its pictures, links and rooms (`tour.json`)."""

import re
from typing import Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

SHOWN = 8
"""Ids named in an error, so that it stays one line."""


class Link(BaseModel):
    """Where the place of picture `to` lies in picture `from`.

    Attributes:
        bearing_deg: counter-clockwise, 0 is the centre column, degrees.
    """

    model_config = ConfigDict(frozen=True, coerce_numbers_to_str=True)
    source: str = Field(alias="from")
    to: str
    bearing_deg: float = Field(ge=-360.0, le=360.0)


class TourFile(BaseModel):
    """The file as people write it.

    Attributes:
        pictures: ids; the picture lies beside the file as ID.jpg or ID.png.
        rooms: which room a picture shows; different rooms of one kind look alike.
    """

    model_config = ConfigDict(frozen=True, coerce_numbers_to_str=True)
    name: str = Field(min_length=1)
    pictures: tuple[str, ...] = Field(min_length=2)
    links: tuple[Link, ...] = ()
    rooms: dict[str, str] = {}

    @model_validator(mode="after")
    def _ids_are_known(self) -> Self:
        if twice := sorted({one for one in self.pictures if self.pictures.count(one) > 1}):
            raise ValueError(f"pictures: expected ids that differ, got {twice} twice: name each picture once")
        ids = ", ".join(self.pictures[:SHOWN]) + (", ..." if len(self.pictures) > SHOWN else "")
        for place, given in [
            *((f"links.{n}.from", link.source) for n, link in enumerate(self.links)),
            *((f"links.{n}.to", link.to) for n, link in enumerate(self.links)),
            *((f"rooms.{one}", one) for one in self.rooms),
        ]:
            if given not in self.pictures:
                raise ValueError(
                    f"{place}: expected an id of pictures ({ids}), got {given!r}: "
                    "correct the id, or add it to pictures"
                )
        for n, link in enumerate(self.links):
            if link.source == link.to:
                raise ValueError(f"links.{n}: expected two pictures, got {link.to!r} twice: remove this link")
        return self


def kind_of(room: str) -> str:
    """A room's name without its numbers."""
    return re.sub(r"\d+", "", room)
