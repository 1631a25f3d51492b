"""Who gets in whose way, and whether all can still get to where they want. Pure.

The banker's rule (Dijkstra, EWD 623; for vehicles on a graph Reveliotis 2000): what is granted must leave an
order in which all can end their ways one after the other, each while the others stand where they are.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from services.fleet.traffic.nearness import Body, Nearness


@dataclass(frozen=True)
class Party:
    """One robot.

    Attributes:
        held: nodes of the way that it is on, in order; empty where nobody knows where it is.
        wish: nodes of its way beyond them.
        stays: it has nothing to do and stands there until it is sent away.
    """

    name: str
    held: tuple[int, ...]
    wish: tuple[int, ...] = ()
    stays: bool = False

    def granted(self, count: int) -> "Party":
        """The same with so many nodes more."""
        return Party(self.name, self.held + self.wish[:count], self.wish[count:])


def clear_share(near: Nearness, held: Sequence[int], wish: Sequence[int], other: Body) -> int:
    """How many nodes of a wish can be driven to beside another robot; who is too near may go away from it.

    Args:
        near: the map.
        held: where the way begins.
        wish: its nodes from there on.
        other: what the other one takes up.
    """
    too_near = not other.zone.isdisjoint(held)
    apart_m = near.apart_m(held, other.nodes) if too_near else 0.0
    for count, leg in enumerate(pairwise((*held[-1:], *wish)) if held else zip(wish, wish, strict=True)):
        end = leg[1]
        if end not in other.zone and other.nodes.isdisjoint(near.zone(leg)):
            too_near = False
            continue
        further_m = near.apart_m([end], other.nodes) if too_near else 0.0
        if not too_near or further_m <= apart_m:
            return count
        apart_m = further_m
    return len(wish)


def can_end(near: Nearness, parties: Mapping[str, Party]) -> set[str]:
    """Names of those who can get to the end of their wishes, one after the other; who got there goes away."""
    there = {name: near.body(party.held) for name, party in parties.items()}
    left = {name: party for name, party in parties.items() if not party.stays}
    ended: set[str] = set()
    going_on = True
    while going_on:
        going_on = False
        for name, party in list(left.items()):
            others = (body for other, body in there.items() if other != name)
            if all(clear_share(near, party.held, party.wish, body) == len(party.wish) for body in others):
                ended.add(name)
                del left[name], there[name]
                going_on = True
    return ended


def in_the_way(near: Nearness, party: Party, others: Iterable[Party]) -> list[Party]:
    """Those who stand on the wish of one of them."""
    return [
        other
        for other in others
        if other.name != party.name
        and clear_share(near, party.held, party.wish, near.body(other.held)) < len(party.wish)
    ]
