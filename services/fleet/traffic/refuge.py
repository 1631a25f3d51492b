"""Where a robot that is in the way of others can go meanwhile. Pure."""

import heapq
from collections.abc import Collection, Iterator, Mapping

from services.fleet.traffic.nearness import Nearness
from services.fleet.traffic.parties import Party, can_end, clear_share, in_the_way

FAR_M = 25.0
"""Nobody makes room by a way that costs more; chosen: across a floor of an office."""


def way_to_refuge(
    near: Nearness,
    name: str,
    parties: Mapping[str, Party],
    waiting: Collection[str],
    tried: Collection[int],
    going: Collection[str] = (),
) -> tuple[int, ...]:
    """The cheapest way to where one of those that wait is let by, else to where fewer are kept; () for none.

    Args:
        near: the map.
        name: who makes room.
        parties: all robots, it among them.
        waiting: names of those that cannot get to the end of their ways.
        tried: nodes that are no refuge for it.
        going: names of those who will go out of its way first.

    Returns:
        Nodes in order, from one that it holds.
    """
    others = {other: party for other, party in parties.items() if other != name}
    kept = _kept(near, parties[name], others, waiting)
    fewer: tuple[int, ...] = ()
    for way in _ways(near, parties[name], others, going):
        if way[-1] in tried:
            continue
        there = Party(name, way[-1:], stays=True)
        if can_end(near, {**others, name: there}) & set(waiting):
            return way
        if not fewer and _kept(near, there, others, waiting) < kept:
            fewer = way
    return fewer


def _kept(near: Nearness, own: Party, others: Mapping[str, Party], waiting: Collection[str]) -> int:
    """How many of those that wait have it on their way."""
    return sum(bool(in_the_way(near, others[name], [own])) for name in waiting)


def _ways(
    near: Nearness, own: Party, others: Mapping[str, Party], going: Collection[str]
) -> Iterator[tuple[int, ...]]:
    """Ways that are clear of others but those that are `going`, to nodes clear of all, the cheapest first."""
    bodies = [near.body(party.held) for party in others.values()]
    standing = [near.body(party.held) for other, party in others.items() if other not in going]
    ways: list[tuple[float, tuple[int, ...]]] = [(0.0, (node,)) for node in own.held]
    seen: set[int] = set()
    while ways:
        cost_m, way = heapq.heappop(ways)
        node = way[-1]
        if node in seen or cost_m > FAR_M:
            continue
        seen.add(node)
        spot = near.zone((node, node))
        if all(node not in body.zone and spot.isdisjoint(body.nodes) for body in bodies):
            yield way
        for beside in sorted(near.graph.adj.get(node, {})):
            if beside not in seen and all(clear_share(near, (node,), (beside,), body) for body in standing):
                heapq.heappush(ways, (cost_m + near.graph.edges[node, beside]["cost_m"], (*way, beside)))
