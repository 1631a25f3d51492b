"""Marks on a map: names of places, rules, routes that people teach, signs read there. Part of the map."""

import math
import unicodedata
from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from shared.messages.base import Bearing, Part

NAME_MAX = 64
"""Characters of a name; chosen: as many as those of maps have."""
LISTED_MAX = 5_000
"""Nodes of one area, and edges of one rule; chosen: 60 kB as JSON, which one request may hold."""


def checked_name(text: str) -> str:
    """A name as it is kept: composed characters, single spaces, nothing that cannot be seen.

    Raises:
        ValueError: empty, or with characters that control a terminal or hide among others (Unicode C*).
    """
    if any(unicodedata.category(character).startswith("C") for character in text):
        raise ValueError("a name must have no control characters nor invisible ones")
    name = " ".join(unicodedata.normalize("NFC", text).split())
    if not name:
        raise ValueError("a name must have at least one character that is no space")
    return name


def key_of(name: str) -> str:
    """What two names have in common that mean the same: case tells none apart."""
    return checked_name(name).casefold()


PlaceName = Annotated[str, Field(min_length=1, max_length=NAME_MAX), AfterValidator(checked_name)]
"""Untrusted text: bounded, of any script, without control characters."""
NodeIds = Annotated[
    tuple[Annotated[int, Field(ge=0, lt=2**63)], ...], Field(max_length=LISTED_MAX, fail_fast=True)
]


def _two_nodes(pair: tuple[int, int]) -> tuple[int, int]:
    if pair[0] == pair[1]:
        raise ValueError(f"an edge joins two nodes, got node {pair[0]} twice")
    return pair


Way = Annotated[
    tuple[Annotated[int, Field(ge=0, lt=2**63)], Annotated[int, Field(ge=0, lt=2**63)]],
    AfterValidator(_two_nodes),
]
"""From one node to another; which of them is first counts for one-way edges only."""
Ways = Annotated[tuple[Way, ...], Field(max_length=LISTED_MAX, fail_fast=True)]

SIGHTINGS_MAX = 24
"""Nodes from which one sign is kept; chosen: all those of a corridor that can read a plate in it."""

Day = Literal["mon", "tue", "wed", "thu", "fri", "sat", "sun"]
DAYS: tuple[Day, ...] = ("mon", "tue", "wed", "thu", "fri", "sat", "sun")


class Mark(Part):
    """Something with a name."""

    name: PlaceName


class EdgeRule(Mark):
    """A rule about edges, each a pair of nodes."""

    edges: Ways = ()


class Place(Mark):
    """A name of one node, or of several: an area.

    Attributes:
        nodes: the first is the one to drive to. Nodes that are deleted leave; an empty place keeps its name.
    """

    nodes: NodeIds = ()


class Route(Mark):
    """Nodes to be driven to one after the other, as they were taught; one may come more than once.

    Attributes:
        nodes: in the order of driving. Nodes that are deleted leave; where those before and after are not
            joined, the route has a gap until it is put anew.
    """

    nodes: NodeIds = ()


class Sighting(Part):
    """How a sign is read from a node.

    Attributes:
        node: the node.
        bearing_rad: where it is, in the node's camera frame, counter-clockwise from ahead.
        height_rad: how high its line of text appears: the larger, the nearer.
        confidence: of the reading.
    """

    node: int = Field(ge=0, lt=2**63)
    bearing_rad: Bearing
    height_rad: float = Field(gt=0.0, le=math.pi)
    confidence: float = Field(ge=0.0, le=1.0)


class Sign(Mark):
    """Text that robots read, such as a room number; its name is what it says.

    Attributes:
        sightings: of each node one, the best first. Nodes that are deleted leave with theirs.
    """

    sightings: Annotated[tuple[Sighting, ...], Field(max_length=SIGHTINGS_MAX)] = ()


class KeepOut(Mark):
    """Nodes that no robot may go to or through.

    Attributes:
        areas: places whose nodes are meant as well, whichever they are by now.
    """

    kind: Literal["keep_out"] = "keep_out"
    nodes: NodeIds = ()
    areas: Annotated[tuple[PlaceName, ...], Field(max_length=100)] = ()


class OneWay(EdgeRule):
    """Edges that are driven from their first node to their second only."""

    kind: Literal["one_way"] = "one_way"


class Slow(EdgeRule):
    """Edges that are driven slowly.

    Attributes:
        speed_share: of the speed that a robot would have there.
    """

    kind: Literal["slow"] = "slow"
    speed_share: float = Field(default=0.5, ge=0.1, le=1.0)


class Hours(Part):
    """A span of each of some days, local time.

    Attributes:
        opens, closes: "HH:MM", up to "24:00"; a span that does not close after it opens lasts into the next
            day.
    """

    days: Annotated[tuple[Day, ...], Field(min_length=1, max_length=7)] = DAYS
    opens: str = Field(pattern=r"^([01][0-9]|2[0-3]):[0-5][0-9]$")
    closes: str = Field(pattern=r"^(([01][0-9]|2[0-3]):[0-5][0-9]|24:00)$")


class OpeningHours(EdgeRule):
    """Edges, such as a door, that are there at some hours only.

    Attributes:
        hours: when; without any the edges are closed.
        time_zone: by its IANA name, such as Europe/Berlin.
    """

    kind: Literal["opening_hours"] = "opening_hours"
    hours: Annotated[tuple[Hours, ...], Field(max_length=50)] = ()
    time_zone: str = Field(default="UTC", max_length=64, pattern=r"^[A-Za-z0-9_+-]+(/[A-Za-z0-9_+-]+){0,2}$")


Rule = Annotated[KeepOut | OneWay | Slow | OpeningHours, Field(discriminator="kind")]


class PutPlace(Part):
    """Name nodes, or give a name other nodes."""

    op: Literal["put_place"] = "put_place"
    place: Place


class DeletePlace(Part):
    """Forget a name; its nodes stay."""

    op: Literal["delete_place"] = "delete_place"
    name: PlaceName


class PutRoute(Part):
    """Keep a route, or replace the one of the same name."""

    op: Literal["put_route"] = "put_route"
    route: Route


class DeleteRoute(Part):
    """Forget a route; its nodes stay."""

    op: Literal["delete_route"] = "delete_route"
    name: PlaceName


class PutSign(Part):
    """Keep a sign, or replace the one that says the same."""

    op: Literal["put_sign"] = "put_sign"
    sign: Sign


class DeleteSign(Part):
    """Forget a sign."""

    op: Literal["delete_sign"] = "delete_sign"
    name: PlaceName


class PutRule(Part):
    """Add a rule or replace the one of the same name."""

    op: Literal["put_rule"] = "put_rule"
    rule: Rule


class DeleteRule(Part):
    """Lift a rule."""

    op: Literal["delete_rule"] = "delete_rule"
    name: PlaceName


class Marks(Part):
    """What people wrote on a map, and what robots read there."""

    places: tuple[Place, ...] = Field(default=(), fail_fast=True)
    rules: tuple[Rule, ...] = Field(default=(), fail_fast=True)
    routes: tuple[Route, ...] = Field(default=(), fail_fast=True)
    signs: tuple[Sign, ...] = Field(default=(), fail_fast=True)

    @model_validator(mode="after")
    def _named_once(self) -> "Marks":
        for kind in (self.places, self.rules, self.routes, self.signs):
            if len({key_of(mark.name) for mark in kind}) != len(kind):
                raise ValueError("a name stands there twice")
        return self
