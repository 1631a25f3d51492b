"""Who may drive where: claims of robots, and what is granted to them. Knows no bus; the time is told.

Nothing is kept for good. A robot says again and again where it is and where it wants to go; one that is
silent for LEASE_S holds nothing any more.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import chain

from services.fleet.traffic.nearness import Nearness
from services.fleet.traffic.parties import Party, can_end, clear_share, in_the_way
from services.fleet.traffic.refuge import way_to_refuge

LEASE_S = 4.0
"""A silent robot keeps what it holds for so long; chosen: planners speak once a second, and are heard after
three of them were lost."""
ORDER_S = 15.0
"""Who was told to make room and did not set out meanwhile is told again; chosen: a task begins in five."""
AGAIN_S = 60.0
"""Nobody is sent to one refuge twice within so long: it may not have got there; chosen."""
AHEAD = 2
"""Nodes granted ahead where nothing speaks against it; chosen: with three, a fleet of four takes a tenth
longer (tests/benchmarks/test_fleet_traffic.py), with one a robot stops at every node."""


@dataclass(frozen=True)
class Claim:
    """What one robot holds and wants.

    Attributes:
        map: in which it is.
        at: nodes between which it is, the one that it heads for last; empty where nobody knows.
        ahead: nodes of its way beyond, of which `free` are granted.
        busy: on a mission, and gone from where it is some time.
        room: the way by which it was told to make room, until it goes there; `told_s` when.
        heard_s: when it spoke last.
    """

    robot: str
    map: str
    at: tuple[int, ...] = ()
    ahead: tuple[int, ...] = ()
    free: int = 0
    busy: bool = True
    room: tuple[int, ...] = ()
    told_s: float = 0.0
    heard_s: float = 0.0

    @property
    def party(self) -> Party:
        """As it counts for others: one that is to make room wants that, and nothing else."""
        held = self.at + self.ahead[: self.free]
        if self.room:
            start, *way = self.room
            return Party(self.robot, (*(node for node in held if node != start), start), tuple(way))
        return Party(self.robot, held, self.ahead[self.free :], stays=not self.busy)


@dataclass(frozen=True)
class Grant:
    """What a robot is told.

    Attributes:
        free: how many of the nodes ahead it may drive to.
        why: what the next one waits for; "" where nothing keeps it.
        room: nodes of the way by which it is to make room for others, instead of its own way; else empty.
    """

    free: int
    why: str = ""
    room: tuple[int, ...] = ()


class Rights:
    """All claims."""

    def __init__(self) -> None:
        self.claims: dict[str, Claim] = {}
        self._told: dict[tuple[str, int], float] = {}

    def ask(self, claim: Claim, near: Nearness, now_s: float) -> Grant:
        """A robot says where it is and where it wants to go.

        Args:
            claim: what it says; nothing is granted yet.
            near: the map as it is.
            now_s: monotonic.
        """
        robot, name, ahead = claim.robot, claim.map, claim.ahead
        self.note(claim, now_s)
        claim = self.claims[robot]
        parties = self._parties(name)
        free = self._grantable(robot, parties, near)
        self.claims[robot] = claim = replace(claim, free=claim.free + free)
        blockers = in_the_way(near, claim.party, self._parties(name).values()) if ahead else []
        if blockers and not claim.room:
            self._clear_way(robot, blockers, near, now_s)
            claim = self.claims[robot]
        if claim.free == len(ahead) or not blockers:
            return Grant(claim.free, room=claim.room)
        names = ", ".join(party.name for party in blockers)
        return Grant(claim.free, f"the way beyond is taken by {names}", claim.room)

    def note(self, claim: Claim, now_s: float) -> Grant:
        """A robot says the same, and is granted no more than before."""
        self._forget(now_s)
        self.claims[claim.robot] = renewed = self._renewed(claim, now_s)
        return Grant(renewed.free)

    def standing(self, now_s: float) -> list[Claim]:
        """Robots that were told to make room and have no way of their own: somebody has to send them."""
        self._forget(now_s)
        return [claim for claim in self.claims.values() if claim.room and not claim.busy]

    def _forget(self, now_s: float) -> None:
        self.claims = {n: claim for n, claim in self.claims.items() if now_s - claim.heard_s < LEASE_S}
        self._told = {order: told_s for order, told_s in self._told.items() if now_s - told_s < AGAIN_S}

    def _renewed(self, claim: Claim, now_s: float) -> Claim:
        """The claim with what was granted before of the way that it still wants."""
        before = self.claims.get(claim.robot)
        if before is None or before.map != claim.map:
            return replace(claim, heard_s=now_s)
        held = before.ahead[: before.free]
        free = next((i for i, node in enumerate(claim.ahead) if node not in held), len(claim.ahead))
        end = (*claim.at, *claim.ahead)[-1:]
        done = not before.room or end == before.room[-1:] or now_s - before.told_s > ORDER_S
        room, told_s = ((), 0.0) if done else (before.room, before.told_s)
        return replace(claim, free=free, room=room, told_s=told_s, heard_s=now_s)

    def _parties(self, name: str) -> dict[str, Party]:
        return {robot: claim.party for robot, claim in self.claims.items() if claim.map == name}

    def _grantable(self, robot: str, parties: Mapping[str, Party], near: Nearness) -> int:
        """Nodes more after which it can get to the end of its way, and whoever could before still can."""
        own = parties[robot]
        more = AHEAD - self.claims[robot].free
        if self.claims[robot].room or not own.wish or more <= 0:
            return 0
        bodies = [near.body(party.held) for party in parties.values() if party.name != robot]
        clear = len(own.wish)
        for body in bodies:
            clear = min(clear, clear_share(near, own.held, own.wish, body))
        if len(parties) == 1:
            return min(clear, more)
        able = can_end(near, parties) | {robot}
        usual = min(clear, more)
        for count in chain(range(usual, 0, -1), range(usual + 1, clear + 1)):
            if able <= can_end(near, {**parties, robot: own.granted(count)}):
                return count
        return 0

    def _clear_way(self, robot: str, blockers: list[Party], near: Nearness, now_s: float) -> None:
        """Tell somebody to make room: who has nothing to do there, or else one of those who cannot go on.

        Of robots that wait for one another the one with the shortest way to a refuge makes room. Who has
        nothing to do and is shut in is told to come out past others, sooner past such as have nothing to do
        either: it waits for them from then on, and they are told to make room in turn.
        """
        parties = self._parties(self.claims[robot].map)
        waiting = _jam(near, robot, parties)
        idle = [party.name for party in blockers if party.stays]
        asked = idle or waiting
        if any(self.claims[name].room for name in asked):
            return
        shut_in_by = ((), [name for name, party in parties.items() if party.stays], list(parties))
        for going in shut_in_by if idle else ((),):
            ways = {
                name: way_to_refuge(near, name, parties, set(waiting) - {name}, self._tried(name), going)
                for name in asked
            }
            if found := [(len(way), name) for name, way in ways.items() if way]:
                _, name = min(found)
                self.claims[name] = replace(self.claims[name], room=ways[name], told_s=now_s)
                self._told[name, ways[name][-1]] = now_s
                return

    def _tried(self, name: str) -> set[int]:
        """Refuges that a robot was sent to not long ago."""
        return {node for robot, node in self._told if robot == name}


def _jam(near: Nearness, robot: str, parties: Mapping[str, Party]) -> list[str]:
    """Robots on their way that cannot get to its end, a given one and whom it waits for, and so on."""
    stuck = parties.keys() - can_end(near, parties)
    jam, left = set[str](), {robot} & stuck
    while left:
        name = left.pop()
        jam.add(name)
        waits_for = {party.name for party in in_the_way(near, parties[name], parties.values())}
        left |= (waits_for & stuck) - jam
    return sorted(name for name in jam if not parties[name].stays)
