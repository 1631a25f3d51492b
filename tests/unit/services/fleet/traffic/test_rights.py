"""Rights of way: what is granted, to whom first, who makes room, and when a lease ends."""

from dataclasses import dataclass, field
from itertools import combinations

import networkx as nx
import numpy as np
import pytest

from services.fleet.traffic.nearness import Nearness
from services.fleet.traffic.rights import AHEAD, LEASE_S, Claim, Rights
from tests.unit.services.fleet.traffic.corridors import corridor

CROSSING = {6: (20, 21, 22, 23), 3: (30, 31, 32)}


def test_alone_a_robot_is_granted_what_it_looks_ahead_and_no_more():
    rights, near = Rights(), corridor(12)
    assert rights.ask(Claim("r1", "flat", (0,), (1, 2, 3, 4, 5)), near, 0.0).free == AHEAD
    assert rights.ask(Claim("r1", "flat", (0,), (1, 2, 3, 4, 5)), near, 0.1).free == AHEAD
    assert rights.ask(Claim("r1", "flat", (0, 1), (2, 3, 4, 5)), near, 0.2).free == AHEAD


def test_asked_again_and_again_it_is_granted_no_more_while_another_drives_far_away():
    rights, near = Rights(), corridor(30)
    rights.ask(Claim("r2", "flat", (25,), (26, 27)), near, 0.0)
    for now_s in (0.1, 0.2, 0.3):
        assert rights.ask(Claim("r1", "flat", (0,), (1, 2, 3, 4, 5)), near, now_s).free == AHEAD


def test_the_second_waits_and_is_told_for_whom():
    rights, near = Rights(), corridor(12, CROSSING)
    rights.ask(Claim("r1", "flat", (4,), (5, 6, 7)), near, 0.0)
    waiting = rights.ask(Claim("r2", "flat", (21,), (20, 6, 5, 4, 3)), near, 0.1)
    assert (waiting.free, waiting.why) == (0, "the way beyond is taken by r1")


def test_what_is_passed_is_free_for_the_next():
    rights, near = Rights(), corridor(12, CROSSING)
    for now_s, at, ahead in ((0.0, 4, (5, 6, 7, 8, 9, 10)), (1.0, 8, (9, 10))):
        rights.ask(Claim("r1", "flat", (at,), ahead), near, now_s)
    assert rights.ask(Claim("r2", "flat", (22,), (21, 20, 6)), near, 1.1).free == AHEAD


def test_a_narrow_stretch_is_granted_whole_or_not_at_all():
    rights, near = Rights(), corridor(12, {0: (30, 31, 32), 11: (40, 41, 42)})
    into = rights.ask(Claim("r1", "flat", (31,), (30, *range(12), 40, 41, 42)), near, 0.0)
    assert into.free == AHEAD
    against = rights.ask(Claim("r2", "flat", (42,), (41, 40, *range(11, -1, -1), 30, 31, 32)), near, 0.1)
    assert against.free == 0


def test_robots_in_other_maps_are_in_nobodys_way():
    rights, near = Rights(), corridor(12)
    rights.ask(Claim("r1", "flat", (5,)), near, 0.0)
    assert rights.ask(Claim("r2", "hall", (3,), (4, 5, 6)), near, 0.1).free == AHEAD


def test_a_silent_robot_frees_its_leg_when_its_lease_ends():
    rights, near = Rights(), corridor(12)
    rights.ask(Claim("r1", "flat", (5, 6), (7,)), near, 0.0)
    ahead = (4, 5, 6, 7, 8)
    assert rights.ask(Claim("r2", "flat", (3,), ahead), near, LEASE_S - 0.1).free == 0
    assert rights.ask(Claim("r2", "flat", (3,), ahead), near, LEASE_S).free == AHEAD


def test_one_that_has_nothing_to_do_is_sent_out_of_the_way():
    rights, near = Rights(), corridor(12, CROSSING)
    rights.ask(Claim("r2", "flat", (6,), busy=False), near, 0.0)
    rights.ask(Claim("r1", "flat", (3,), tuple(range(4, 12))), near, 0.1)
    (sent,) = rights.standing(0.2)
    assert (sent.robot, sent.room) == ("r2", (6, 20, 21))
    rights.ask(Claim("r2", "flat", (6,), (20, 21)), near, 0.3)
    assert rights.standing(0.4) == []


def test_nobody_is_sent_to_one_refuge_twice_within_a_minute():
    rights, near = Rights(), corridor(12, CROSSING)
    rooms = []
    for now_s in np.arange(0.0, 40.0, 1.0):
        rights.ask(Claim("r2", "flat", (6,), busy=False), near, now_s)
        rights.ask(Claim("r1", "flat", (3,), tuple(range(4, 12))), near, now_s)
        rooms += [claim.room[-1] for claim in rights.standing(now_s)]
    assert list(dict.fromkeys(rooms)) == [21, 22, 23]


@dataclass
class Driver:
    """Goes a node further with each step that it is granted."""

    name: str
    at: int
    goal: int
    way: list[int] = field(default_factory=list)
    makes_room: bool = False
    waited: int = 0

    def plan(self, near: Nearness) -> None:
        self.way = nx.shortest_path(near.graph, self.at, self.goal)[1:]

    def step(self, rights: Rights, near: Nearness, now_s: float) -> None:
        grant = rights.ask(Claim(self.name, "flat", (self.at,), tuple(self.way)), near, now_s)
        if grant.room and not self.makes_room:
            self.way, self.makes_room = [node for node in grant.room if node != self.at], True
        elif grant.free:
            self.at = self.way.pop(0)
        else:
            self.waited += 1
        if not self.way and self.makes_room:
            self.makes_room = False
            self.plan(near)


def drive(near: Nearness, drivers: list[Driver], steps: int) -> list[Driver]:
    """Until all are at their goals, which each leaves at once; those that are left after so many steps.

    Nobody comes too near to anybody.
    """
    rights, left = Rights(), list(drivers)
    for driver in left:
        driver.plan(near)
    for step in range(steps):
        for driver in list(left):
            driver.step(rights, near, float(step))
            if driver.at == driver.goal and not driver.makes_room:
                left.remove(driver)
                del rights.claims[driver.name]
        for one in left:
            for other in left:
                assert one is other or near.apart_m([one.at], [other.at]) > 1.0, step
    return left


def test_two_head_on_in_a_corridor_get_past_each_other_by_a_room():
    drivers = [Driver("r1", 0, 11), Driver("r2", 11, 0)]
    assert drive(corridor(12, {6: (20, 21, 22)}), drivers, 60) == []


@pytest.mark.parametrize("seed", [*range(8), 39, 59])  # the last: one alone that makes room helps nobody
def test_many_in_a_corridor_with_rooms_all_get_to_where_they_want(seed):
    rooms = {door: tuple(range(100 + 10 * door, 104 + 10 * door)) for door in (2, 5, 8, 11)}
    near, rng = corridor(14, rooms), np.random.default_rng(seed)
    spots = [103 + 10 * door for door in rooms]
    drivers = [
        Driver(f"r{i}", int(at), int(goal))
        for i, (at, goal) in enumerate(zip(spots, rng.permutation(spots), strict=True))
    ]
    assert [driver.name for driver in drive(near, drivers, 400)] == []


@pytest.mark.parametrize("others", [(), (Driver("r1", 5, 5),)])
def test_one_that_has_nothing_to_do_in_a_dead_end_comes_out_past_who_wants_in(others):
    """As r5 stood at the end of a room of the office, r6 in its door, and r1 idle before that."""
    rights, near = Rights(), corridor(12, {6: (20, 21, 22, 23)})
    idle, wants_in = [Driver("r5", 23, 23), *others], Driver("r6", 20, 23)
    wants_in.plan(near)
    for step in range(80):
        for one in idle:
            if one.way:
                one.step(rights, near, float(step))
            else:
                rights.ask(Claim(one.name, "flat", (one.at,), busy=False), near, float(step))
        rooms = {claim.robot: claim.room for claim in rights.standing(float(step))}
        for one in idle:
            one.way = one.way or list(rooms.get(one.name, ())[1:])
        if wants_in.at != wants_in.goal or wants_in.makes_room:
            wants_in.step(rights, near, float(step))
        everybody = [one.at for one in (*idle, wants_in)]
        assert all(near.apart_m([a], [b]) > 1.0 for a, b in combinations(everybody, 2)), step
    assert wants_in.at == 23
