"""Two maps become one where they share places, and only there."""

import math
from dataclasses import replace

import numpy as np
import pytest

from services.gateway.merging.core.candidates import Candidate, MergeRefusedError, candidates_of
from services.gateway.merging.core.choice import choose
from services.gateway.merging.core.operations import OPERATIONS_MAX, check_size, merged
from services.gateway.merging.core.places import Places
from services.gateway.merging.core.witnesses import borne_out, loop_closes, votes_among
from shared.mapgraph.triangle import Sight
from shared.messages.maps import AddNode, Edge, Node, PutEdge
from tests.merge_world import apart_m, edges_of, features_of, map_of, match, matches_of, row, seen, together

ERROR_RAD = math.radians(2.0)
STREET_M = 60.0
"""The look-alike street lies so far beside the true one."""


class World:
    """A base map of one street and a far equal one, joined by a long way, and another map of the first.

    Places 0 to 11 are the street, 12 to 23 the equal one; `other` overlaps the second half of the first.
    """

    def __init__(self, seed: int) -> None:
        self.rng = rng = np.random.default_rng(seed)
        street = row(rng, 0.0, 0.0, 12)
        self.base = dict(enumerate(street + [pose.moved(0.0, STREET_M) for pose in street]))
        way = [pose for k in range(1, 60) for pose in row(rng, 11.0, float(k), 1)]
        self.base |= {24 + k: pose for k, pose in enumerate(way)}
        self.other = {3 * k + 1: pose for k, pose in enumerate(row(rng, 6.3, 0.35, 12))}
        self.base_map = map_of(self.base, rng, ERROR_RAD)
        self.other_map = map_of(self.other, rng, ERROR_RAD)

    def true_matches(self):
        return matches_of(self.base, self.other, self.rng, ERROR_RAD)

    def look_alikes(self, count):
        """The first places of `other` look like the far street as well."""
        some = {n: self.other[n] for n in sorted(self.other)[:count]}
        return matches_of(self.base, some, self.rng, ERROR_RAD, (0.0, STREET_M))

    def wrong(self, chosen):
        return [one for one in chosen if apart_m(self.base[one.base], self.other[one.other]) > 2.0]


@pytest.fixture(params=range(6))
def world(request):
    return World(request.param)


def test_overlapping_rows_are_joined_along_the_whole_overlap(world):
    chosen = choose(world.base_map, world.other_map, world.true_matches())
    assert {one.other for one in chosen} >= {n for n, pose in world.other.items() if pose.x_m < 11.0}
    assert world.wrong(chosen) == []


def test_a_look_alike_street_far_away_is_not_joined(world):
    matches = together(world.true_matches(), world.look_alikes(3))
    assert any(m.node_id in range(12, 24) for found in matches.values() for m in found)
    chosen = choose(world.base_map, world.other_map, matches)
    assert len(chosen) >= 10
    assert world.wrong(chosen) == []


def test_two_ways_that_fit_alike_are_refused(world):
    matches = together(world.true_matches(), world.look_alikes(12))
    with pytest.raises(MergeRefusedError, match="fit in two ways, which cannot both be true"):
        choose(world.base_map, world.other_map, matches)


def test_a_part_turned_another_way_is_outvoted():
    """Equal houses at both ends of a long street, the far ones seen as if the street had turned."""
    world = World(1)
    matches = world.true_matches()
    far = {m.node_id for found in matches.values() for m in found if world.base[m.node_id].x_m > 10.2}
    turned = {
        n: [
            m.model_copy(
                update={"heading_rad": m.heading_rad, "yaw_rad": math.remainder(m.yaw_rad + 1, 6.28)}
            )
            if m.node_id in far
            else m
            for m in found
        ]
        for n, found in matches.items()
    }
    chosen = choose(world.base_map, world.other_map, turned)
    assert chosen
    assert not far & {one.base for one in chosen}


def test_look_alikes_in_directions_that_do_not_fit_are_no_shared_places(world):
    rng = world.rng
    lost = {n: pose.moved(300.0, 0.0) for n, pose in world.other.items()}
    matches = {}
    for n in sorted(lost)[:8]:
        place = int(rng.integers(0, 12))
        seemingly = world.base[place].moved(*rng.uniform(-1.0, 1.0, 2))
        one = match(place, seemingly, world.base[place], rng)
        matches[n] = [one.model_copy(update={"yaw_rad": float(rng.uniform(-3.1, 3.1))})]
    told = r"the maps share no place: 8 of 12 look alike, none is borne out|share too little: 8 of 12"
    with pytest.raises(MergeRefusedError, match=told):
        choose(world.base_map, map_of(lost, rng), matches)


def test_maps_without_overlap_are_refused_with_the_count():
    world = World(0)
    with pytest.raises(MergeRefusedError, match="the maps share no place: 0 of 12 look alike"):
        choose(world.base_map, world.other_map, {n: [] for n in world.other})


def test_seven_connections_are_too_few_and_eight_are_enough():
    world = World(0)
    some = choose(world.base_map, world.other_map, world.true_matches())[:8]
    matches = {n: [one.match for one in some if one.other == n] for n in {one.other for one in some}}
    assert len(choose(world.base_map, world.other_map, matches)) == 8
    matches[some[-1].other].pop()
    with pytest.raises(MergeRefusedError, match="7 connections are borne out, at least 8 between 2 places"):
        choose(world.base_map, world.other_map, matches)


def test_a_part_turned_against_the_rest_of_the_street_is_another_way_to_fit():
    """Its own loops close; the turns along the street to the rest do not."""
    world = World(4)
    matches = {n: found for n, found in world.true_matches().items() if not 7.8 < world.other[n].x_m < 9.8}
    end = {n for n in matches if world.other[n].x_m >= 9.8}
    assert len(end) >= 2
    for n in end:
        frame = world.other[n]
        turned = replace(frame, yaw_rad=frame.yaw_rad + 0.5)
        matches[n] = [
            match(m.node_id, turned, world.base[m.node_id], world.rng, ERROR_RAD) for m in matches[n]
        ]
    votes = votes_among(
        world.base_map, world.other_map, candidates_of(world.base_map, world.other_map, matches)
    )
    assert end & {one.other for one in borne_out(votes, votes)}
    with pytest.raises(MergeRefusedError, match="fit in two ways"):
        choose(world.base_map, world.other_map, matches)


def test_of_three_the_one_the_others_speak_against_is_dropped_and_so_is_one_alone():
    rng = np.random.default_rng(0)
    here, there = row(rng, 0.0, 0.0, 2)
    one, two, odd, alone = (Candidate(n, n, match(n, here, there, rng), near=True) for n in range(4))
    votes = {
        one: {two: True, odd: False},
        two: {one: True, odd: False},
        odd: {one: False, two: False},
        alone: {},
    }
    assert borne_out(votes, votes) == {one, two}


def test_two_places_that_see_the_same_one_bear_each_other_out():
    world = World(0)
    sure = candidates_of(world.base_map, world.other_map, world.true_matches())
    votes = votes_among(world.base_map, world.other_map, sure)
    same = [agree for one in sure for two, agree in votes[one].items() if one.base == two.base]
    assert len(same) > 10
    assert sum(same) > 0.9 * len(same)


@pytest.mark.parametrize(("most", "joined"), [(124, False), (125, True)])
def test_a_street_that_was_only_seen_from_afar_may_be_an_equal_one(world, most, joined):
    matches = {
        n: [m.model_copy(update={"inliers": min(m.inliers, most)}) for m in found]
        for n, found in world.true_matches().items()
    }
    if joined:
        assert choose(world.base_map, world.other_map, matches)
        return
    with pytest.raises(MergeRefusedError, match="borne out, but not from nearby"):
        choose(world.base_map, world.other_map, matches)


@pytest.mark.parametrize(
    "changes",
    [{"confidence": 0.49}, {"inliers": 44}, {"status": "inconsistent"}, {"yaw_rad": None}],
    ids=lambda changes: next(iter(changes)),
)
def test_a_match_that_cannot_be_trusted_joins_nothing(changes):
    world = World(0)
    weak = {n: [m.model_copy(update=changes) for m in found] for n, found in world.true_matches().items()}
    with pytest.raises(MergeRefusedError, match="0 of 12 look alike"):
        choose(world.base_map, world.other_map, weak)


def test_a_place_taken_at_the_same_spot_is_joined_without_a_direction():
    world = World(2)
    same = {n: world.base[n - 100] for n in range(104, 112)}
    chosen = choose(
        world.base_map, map_of(same, world.rng), matches_of(world.base, same, world.rng, ERROR_RAD)
    )
    here = [one for one in chosen if one.match.status == "no_baseline"]
    assert {(one.other, one.base) for one in here} == {(n, n - 100) for n in same}


def test_after_the_merge_every_connection_points_where_the_places_are(world):
    chosen = choose(world.base_map, world.other_map, world.true_matches())
    operations = merged(world.base_map, world.other_map, {n: features_of(n) for n in world.other}, chosen)
    first = max(world.base) + 1
    new = {first + k: old for k, old in enumerate(sorted(world.other))}
    poses = world.base | {n: world.other[old] for n, old in new.items()}
    added = [step for step in operations if isinstance(step, AddNode)]
    assert [step.node.node_id for step in added] == sorted(new)
    for step in added:
        old = new[step.node.node_id]
        assert step.node == world.other_map.nodes[old].model_copy(update={"node_id": step.node.node_id})
        assert step.features.thumbnail == features_of(old).thumbnail
    edges = [step.edge for step in operations if isinstance(step, PutEdge)]
    assert len(added) + len(edges) == len(operations)
    across = [edge for edge in edges if edge.why == "merged"]
    assert (len(across), len(edges)) == (len(chosen), len(chosen) + len(world.other_map.edges))
    assert all(edge.a < first <= edge.b for edge in across)
    for edge in edges:
        assert_points(edge, poses)


def assert_points(edge, poses):
    there, turned = seen(poses[edge.a], poses[edge.b])
    back, _ = seen(poses[edge.b], poses[edge.a])
    close = 6 * ERROR_RAD
    assert math.remainder(edge.yaw_ab_rad - turned, math.tau) == pytest.approx(0.0, abs=close)
    assert math.remainder(edge.heading_ab_rad - there, math.tau) == pytest.approx(0.0, abs=close)
    assert math.remainder(edge.heading_ba_rad - back, math.tau) == pytest.approx(0.0, abs=close)


def test_a_merge_of_more_than_one_transaction_is_refused():
    nodes = [Node(node_id=n) for n in range(6_000)]
    large = Places(nodes, [Edge(a=n, b=n + 1) for n in range(4_001)])
    with pytest.raises(MergeRefusedError, match=f"10001 places and connections, at most {OPERATIONS_MAX}"):
        check_size(large)
    check_size(Places(nodes, large.edges[:4_000]))
    with pytest.raises(MergeRefusedError, match="10003"):
        check_size(Places(nodes, large.edges[:4_000]), across=3)


def test_connections_that_experience_speaks_against_bear_no_witness():
    world = World(0)
    nodes = world.base_map.nodes.values()
    suspended = [edge.model_copy(update={"suspended": True}) for edge in world.base_map.edges]
    single = {n: found[:1] for n, found in world.true_matches().items()}
    with pytest.raises(MergeRefusedError, match="borne out"):
        choose(Places(nodes, suspended), world.other_map, single)


def test_a_chain_adds_up_the_turns_on_the_way():
    world = World(3)
    exact = map_of(world.base, world.rng)
    chains = exact.chains(2)
    assert chains[9].hops == 7
    for place in (3, 9, 40):
        assert math.remainder(
            chains[place].yaw_rad - seen(world.base[2], world.base[place])[1], math.tau
        ) == (pytest.approx(0.0, abs=1e-9))


SQUARE = [Sight(0.0, math.pi / 2)] * 4
"""Each side ahead, then a quarter turn to the left."""


@pytest.mark.parametrize(
    ("legs", "closes"),
    [
        pytest.param(SQUARE, True, id="a square"),
        pytest.param([*SQUARE[:3], Sight(0.0, 1.2)], False, id="turns that do not add up"),
        pytest.param([Sight(0.0, 0.0)] * 4, False, id="all ahead"),
        pytest.param([Sight(h, 0.0) for h in (0.0, 1.0, 1.5, 2.6)], False, id="all into one half"),
        pytest.param([Sight(0.0, 0.0), Sight(math.pi, 0.0)], True, id="there and back"),
        pytest.param([Sight(0.0, 0.0), Sight(2.0, 0.0)], False, id="there and elsewhere"),
        pytest.param([Sight(None, 0.5), Sight(None, -0.5)], True, id="nobody moved"),
        pytest.param([Sight(None, 0.5), Sight(1.0, -0.5)], False, id="one moved"),
        pytest.param([*SQUARE[:3], Sight(0.0, None)], False, id="a turn nobody knows"),
    ],
)
def test_a_loop_closes_when_turns_add_up_and_directions_lead_back(legs, closes):
    assert loop_closes(legs) is closes


def test_what_the_base_place_sees_of_the_other_is_the_way_back():
    rng = np.random.default_rng(0)
    here, there = row(rng, 0.0, 0.0, 2)
    back = Candidate(1, 0, match(0, here, there, rng), near=True).back
    assert (math.remainder(back.heading_rad, math.tau), back.yaw_rad) == pytest.approx(seen(there, here))


def test_edges_of_the_world_are_true():
    """The measure the other tests go by."""
    rng = np.random.default_rng(0)
    poses = dict(enumerate(row(rng, 0.0, 0.0, 3)))
    for edge in edges_of(poses, rng):
        assert_points(edge, poses)
