"""Rules of a map: what they say at a moment, and that no path is planned against them."""

from datetime import UTC, datetime
from functools import partial
from itertools import pairwise

import networkx as nx
import numpy as np
import pytest

from shared.mapgraph.local.keep_clear import current_limits
from shared.mapgraph.routing import fewest_nodes, plan_path, way_m
from shared.mapgraph.rules import Limits, is_open, limits_at
from shared.messages.places import (
    DeleteRule,
    Hours,
    KeepOut,
    OneWay,
    OpeningHours,
    Place,
    PutPlace,
    PutRule,
    Slow,
)
from shared.wall_clock import WallClock
from tests.unit.shared.mapgraph.local.grid import grid


def at(text):
    """A minute, by its time in UTC."""
    return WallClock(int(datetime.fromisoformat(text).replace(tzinfo=UTC).timestamp() // 60))


NOON = at("2026-11-23T12:00")  # a Monday
DOOR = OpeningHours(name="door", edges=((0, 1),), hours=(Hours(opens="08:00", closes="18:00"),))


def said(*rules, moment=NOON, places=()):
    return limits_at({place.name: place for place in places}, rules, moment)


def test_a_keep_out_forbids_its_nodes_and_those_that_its_areas_have_by_now():
    rule = KeepOut(name="shut", nodes=(5,), areas=("Lab",))
    for nodes in ((1, 2), (3,)):
        assert said(rule, places=[Place(name="lab", nodes=nodes)]).forbidden == dict.fromkeys(
            (5, *nodes), "shut"
        )
    assert said(rule).forbidden == {5: "shut"}


def test_of_two_slow_rules_the_slower_holds_and_both_ways():
    limits = said(
        Slow(name="a", edges=((2, 1),), speed_share=0.5), Slow(name="b", edges=((1, 2),), speed_share=0.3)
    )
    assert (limits.speed_share(1, 2), limits.speed_share(2, 1), limits.speed_share(2, 3)) == (0.3, 0.3, 1.0)


@pytest.mark.parametrize(
    ("zone", "moment", "opened"),
    [
        ("UTC", "2026-11-23T08:00", True),
        ("UTC", "2026-11-23T07:59", False),
        ("UTC", "2026-11-23T17:59", True),
        ("UTC", "2026-11-23T18:00", False),
        ("Europe/Berlin", "2026-11-23T07:00", True),  # winter: an hour ahead
        ("Europe/Berlin", "2026-11-23T17:00", False),
        ("Europe/Berlin", "2026-07-06T06:00", True),  # summer: two
        ("Europe/Berlin", "2026-07-06T05:59", False),
        ("America/New_York", "2026-11-23T12:59", False),
        ("Nowhere/City", "2026-11-23T12:00", False),
    ],
)
def test_hours_are_local_time(zone, moment, opened):
    rule = DOOR.model_copy(update={"time_zone": zone})
    assert is_open(rule, at(moment)) is opened
    assert bool(said(rule, moment=at(moment)).closed) is not opened


@pytest.mark.parametrize(
    ("day", "clock", "opened"),
    [(0, "22:00", True), (1, "05:59", True), (1, "06:00", False), (0, "05:00", False), (1, "23:00", False)],
)
def test_a_span_over_midnight_belongs_to_the_day_it_begins_on(day, clock, opened):
    rule = DOOR.model_copy(update={"hours": (Hours(days=("mon",), opens="22:00", closes="06:00"),)})
    assert is_open(rule, at(f"2026-11-{23 + day}T{clock}")) is opened


def test_without_hours_a_door_is_shut_and_until_24_it_is_open_to_the_last_minute():
    assert not is_open(DOOR.model_copy(update={"hours": ()}), NOON)
    whole = DOOR.model_copy(update={"hours": (Hours(opens="00:00", closes="24:00"),)})
    assert all(is_open(whole, at(f"2026-11-23T{h:02}:59")) for h in range(24))


def test_one_way_edges_are_planned_along_one_way():
    flat, limits = grid(3, 1), said(OneWay(name="lane", edges=((0, 1),)))
    assert plan_path(flat, {0: 0.0}, {2: 0.0}, fewest_nodes, limits=limits) == [0, 1, 2]
    assert plan_path(flat, {2: 0.0}, {0: 0.0}, fewest_nodes, limits=limits) == []
    assert limits.against_path([2, 1, 0]) == "lane"
    assert limits.against_path([0, 1, 2]) == ""


def test_a_way_round_is_taken_where_a_slow_one_takes_longer():
    flat = grid(3, 2)  # 0 1 2 below 3 4 5
    cost = partial(way_m, flat)
    assert plan_path(flat, {0: 0.0}, {2: 0.0}, cost) == [0, 1, 2]
    slow = said(Slow(name="ramp", edges=((0, 1), (1, 2)), speed_share=0.2))
    assert plan_path(flat, {0: 0.0}, {2: 0.0}, cost, limits=slow) == [0, 4, 2]


def test_a_door_is_a_way_at_its_hours_only():
    flat = grid(3, 1)
    for hour, path in ((12, [0, 1, 2]), (20, [])):
        limits = said(DOOR, moment=at(f"2026-11-23T{hour}:00"))
        assert plan_path(flat, {0: 0.0}, {2: 0.0}, fewest_nodes, limits=limits) == path


@pytest.mark.parametrize("seed", range(5))
def test_no_path_to_100_random_goals_enters_three_areas_nor_leads_past_them_too_near(seed):
    """On a grid of a metre, where edges across lead between the nodes of an area as well."""
    columns = 12
    flat, rng = grid(columns, columns), np.random.default_rng(seed)
    roots = rng.choice(len(flat.nodes), 3, replace=False)
    for number, root in enumerate(roots):
        flat.apply([PutPlace(place=Place(name=f"area {number}", nodes=flat.nearest(int(root), 5)))])
        flat.apply([PutRule(rule=KeepOut(name=f"rule {number}", areas=(f"area {number}",)))])
    limits = current_limits(flat, NOON)
    open_ways = nx.Graph(way for way in flat.edges if way not in limits.closed)
    open_ways.remove_nodes_from(limits.forbidden)
    open_ways.add_nodes_from(flat.nodes.keys() - limits.forbidden.keys())
    found = refused = 0
    for _ in range(100):
        start, goal = (int(n) for n in rng.choice(len(flat.nodes), 2, replace=False))
        path = plan_path(flat, {start: 0.0}, {goal: 0.0}, partial(way_m, flat), limits=limits)
        assert not limits.forbidden.keys() & set(path)
        assert limits.against_path(path) == ""
        assert all(not _between(ends, limits, columns) for ends in pairwise(path))
        forbidden = bool({start, goal} & limits.forbidden.keys())
        assert bool(path) == (not forbidden and nx.has_path(open_ways, start, goal))
        found, refused = found + bool(path), refused + forbidden
    assert found > 60
    assert refused > 5


def _between(ends, limits: Limits, columns: int):
    """Whether an edge across leads over the corner between two forbidden nodes."""
    (ax, ay), (bx, by) = ((n % columns, n // columns) for n in ends)
    return ax != bx and ay != by and {ay * columns + bx, by * columns + ax} <= limits.forbidden.keys()


def test_limits_follow_the_rules_of_the_map():
    flat = grid(3, 3)
    assert not current_limits(flat, NOON)
    flat.apply([PutRule(rule=KeepOut(name="shut", nodes=(4,)))])
    assert current_limits(flat, NOON).forbidden == {4: "shut"}
    flat.apply([PutRule(rule=KeepOut(name="SHUT", nodes=(8,)))])
    assert current_limits(flat, NOON).forbidden == {8: "SHUT"}
    flat.apply([DeleteRule(name="shut")])
    assert not current_limits(flat, NOON)


@pytest.mark.parametrize(
    ("wanted", "words"),
    [
        ({4: 0.1, 5: 2.0}, "the goal is forbidden by rule 'shut'"),
        ({5: 0.1, 4: 2.0}, "every way to the goal leads through what rule 'shut' forbids"),
        ({5: 0.1}, "every way to the goal leads through what rule 'shut' forbids"),
    ],
)
def test_a_refusal_names_the_rule(wanted, words):
    assert Limits({4: "shut"}).why_not(wanted) == words
