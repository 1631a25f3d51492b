"""What the rules of a map say at one moment: nodes forbidden, edges closed or slow. Pure."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple, Protocol

from shared.messages.places import DAYS, Hours, KeepOut, OneWay, OpeningHours, Place, Rule, Slow, key_of


class LocalTime(NamedTuple):
    """Day of the week, 0 is Monday, and "HH:MM"."""

    day: int
    clock: str


class Clock(Protocol):
    """One minute, told in any time zone (`shared/wall_clock.py`).

    Attributes:
        minute: tells it from others.
    """

    @property
    def minute(self) -> int:
        """Its number."""

    def local(self, time_zone: str) -> LocalTime | None:
        """Day and time there; None where the time zone is not known."""


@dataclass(frozen=True)
class Limits:
    """Rules as path planning and driving read them.

    Attributes:
        forbidden: nodes not to be gone to nor through, with the name of the rule.
        closed: ways from one node to another that are not open now, likewise.
        slow: share of the usual speed, by way.
        directions: sectors of nodes by which no robot leaves to explore, for they lead to forbidden nodes.
    """

    forbidden: Mapping[int, str] = field(default_factory=dict)
    closed: Mapping[tuple[int, int], str] = field(default_factory=dict)
    slow: Mapping[tuple[int, int], float] = field(default_factory=dict)
    directions: Mapping[int, frozenset[int]] = field(default_factory=dict)

    def __bool__(self) -> bool:
        """Whether there is any."""
        return bool(self.forbidden or self.closed or self.slow)

    def against(self, here: int, there: int) -> str:
        """Name of the rule against going from one node to another; "" where there is none."""
        return self.forbidden.get(there) or self.closed.get((here, there), "")

    def against_path(self, path: Iterable[int]) -> str:
        """Name of the first rule against going on along a path from its first node; "" without any."""
        return next((rule for a, b in pairwise(path) if (rule := self.against(a, b))), "")

    def why_not(self, wanted: Mapping[int, float]) -> str:
        """Why none of some nodes may be gone to, with the name of the rule.

        Args:
            wanted: nodes with the cost of the way from each to the goal.
        """
        nearest = min(wanted, key=lambda node: (wanted[node], node))
        if nearest in self.forbidden:
            return f"the goal is forbidden by rule {self.forbidden[nearest]!r}"
        rules = [self.forbidden[node] for node in sorted(wanted) if node in self.forbidden]
        rules += sorted({*self.forbidden.values()})
        return f"every way to the goal leads through what rule {rules[0]!r} forbids"

    def speed_share(self, here: int, there: int) -> float:
        """Of the speed that a robot would have from one node to another."""
        return self.slow.get((here, there), 1.0)


NO_LIMITS = Limits()


def limits_at(places: Mapping[str, Place], rules: Iterable[Rule], clock: Clock) -> Limits:
    """What the rules say.

    Args:
        places: by the keys of their names.
        rules: those of the map.
        clock: the minute asked about.
    """
    forbidden: dict[int, str] = {}
    closed: dict[tuple[int, int], str] = {}
    slow: dict[tuple[int, int], float] = {}
    for rule in rules:
        match rule:
            case KeepOut():
                inside = (
                    n for area in rule.areas if key_of(area) in places for n in places[key_of(area)].nodes
                )
                forbidden |= dict.fromkeys((*rule.nodes, *inside), rule.name)
            case OneWay():
                closed |= {(b, a): rule.name for a, b in rule.edges}
            case Slow():
                for way in _both_ways(rule.edges):
                    slow[way] = min(slow.get(way, 1.0), rule.speed_share)
            case OpeningHours():
                if not is_open(rule, clock):
                    closed |= dict.fromkeys(_both_ways(rule.edges), rule.name)
    return Limits(forbidden, closed, slow)


def is_open(rule: OpeningHours, clock: Clock) -> bool:
    """Whether the edges are there; shut where the time zone is not known, which harms nobody."""
    local = clock.local(rule.time_zone)
    return local is not None and any(_holds(hours, local) for hours in rule.hours)


def _holds(hours: Hours, local: LocalTime) -> bool:
    today = DAYS[local.day] in hours.days
    if hours.opens < hours.closes:
        return today and hours.opens <= local.clock < hours.closes
    yesterday = DAYS[local.day - 1] in hours.days
    return (today and local.clock >= hours.opens) or (yesterday and local.clock < hours.closes)


def _both_ways(edges: Iterable[tuple[int, int]]) -> list[tuple[int, int]]:
    return [way for a, b in edges for way in ((a, b), (b, a))]
