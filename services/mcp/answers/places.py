"""Where pictures were taken, and what people call nodes."""

from typing import Any, Self

from pydantic import BaseModel


class NamedPlace(BaseModel):
    """What people call nodes of the map; the first is the one to drive to."""

    name: str
    nodes: list[int]


class ReadSign(BaseModel):
    """Text that stands somewhere, written by whoever put it there.

    Attributes:
        nodes: of the map, from which it was read, the best first.
    """

    name: str
    nodes: list[int]

    @classmethod
    def of(cls, told: dict[str, Any]) -> Self:
        """From the gateway's answer."""
        return cls(name=told["name"], nodes=[sighting["node"] for sighting in told["sightings"]])


class SeenPlace(BaseModel):
    """Nodes of the map that show one place, and how many matches speak for it."""

    nodes: list[int]
    support: int


class Whereabouts(BaseModel):
    """Where a picture was taken.

    Attributes:
        verdict: found; ambiguous: at one of several places that look alike; weak; not_found.
        places: the likeliest first.
    """

    verdict: str
    places: list[SeenPlace]

    @classmethod
    def of(cls, told: dict[str, Any]) -> Self:
        """From the gateway's answer."""
        return cls(
            verdict=told["verdict"], places=[SeenPlace.model_validate(place) for place in told["places"]]
        )


class NamedRoute(BaseModel):
    """A way that a person taught.

    Attributes:
        nodes: in the order of driving.
        gaps: pairs of nodes that no edge joins any more; a route with gaps is not driven.
    """

    name: str
    nodes: list[int]
    gaps: list[tuple[int, int]]
