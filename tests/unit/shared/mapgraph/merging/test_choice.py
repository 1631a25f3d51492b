"""Two maps become one where they share places, and only there."""

import math
from dataclasses import replace

import pytest

from shared.mapgraph.merging.candidates import MergeRefusedError, candidates_of
from shared.mapgraph.merging.choice import choose
from shared.mapgraph.merging.sight_graph import SightGraph
from shared.mapgraph.merging.votes import supported, votes_among
from tests.merge_world import ERROR_RAD, Streets, map_of, match, matches_of, together


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
    world = Streets(1)
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
    told = r"the maps share no place: 8 of 12 look alike, none is supported|share too little: 8 of 12"
    with pytest.raises(MergeRefusedError, match=told):
        choose(world.base_map, map_of(lost, rng), matches)


def test_maps_without_overlap_are_refused_with_the_count():
    world = Streets(0)
    with pytest.raises(MergeRefusedError, match="the maps share no place: 0 of 12 look alike"):
        choose(world.base_map, world.other_map, {n: [] for n in world.other})


def test_seven_edges_are_too_few_and_eight_are_enough():
    world = Streets(0)
    some = choose(world.base_map, world.other_map, world.true_matches())[:8]
    matches = {n: [one.match for one in some if one.other == n] for n in {one.other for one in some}}
    assert len(choose(world.base_map, world.other_map, matches)) == 8
    matches[some[-1].other].pop()
    with pytest.raises(MergeRefusedError, match="7 edges are supported, at least 8 between 2 nodes"):
        choose(world.base_map, world.other_map, matches)


def test_a_part_turned_against_the_rest_of_the_street_is_another_way_to_fit():
    """Its own loops close; the turns along the street to the rest do not."""
    world = Streets(4)
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
    assert end & {one.other for one in supported(votes, votes)}
    with pytest.raises(MergeRefusedError, match="fit in two ways"):
        choose(world.base_map, world.other_map, matches)


@pytest.mark.parametrize(("most", "joined"), [(124, False), (125, True)])
def test_a_street_that_was_only_seen_from_afar_may_be_an_equal_one(world, most, joined):
    matches = {
        n: [m.model_copy(update={"inliers": min(m.inliers, most)}) for m in found]
        for n, found in world.true_matches().items()
    }
    if joined:
        assert choose(world.base_map, world.other_map, matches)
        return
    with pytest.raises(MergeRefusedError, match="supported, but not from nearby"):
        choose(world.base_map, world.other_map, matches)


def test_a_place_taken_at_the_same_spot_is_joined_without_a_direction():
    world = Streets(2)
    same = {n: world.base[n - 100] for n in range(104, 112)}
    chosen = choose(
        world.base_map, map_of(same, world.rng), matches_of(world.base, same, world.rng, ERROR_RAD)
    )
    here = [one for one in chosen if one.match.status == "no_baseline"]
    assert {(one.other, one.base) for one in here} == {(n, n - 100) for n in same}


def test_edges_that_experience_speaks_against_support_nothing():
    world = Streets(0)
    nodes = world.base_map.nodes.values()
    suspended = [edge.model_copy(update={"suspended": True}) for edge in world.base_map.edges.values()]
    single = {n: found[:1] for n, found in world.true_matches().items()}
    with pytest.raises(MergeRefusedError, match="supported"):
        choose(SightGraph(nodes, suspended), world.other_map, single)


@pytest.mark.parametrize(
    "changes",
    [{"confidence": 0.49}, {"inliers": 44}, {"status": "inconsistent"}, {"yaw_rad": None}],
    ids=lambda changes: next(iter(changes)),
)
def test_a_match_that_cannot_be_trusted_joins_nothing(changes):
    world = Streets(0)
    weak = {n: [m.model_copy(update=changes) for m in found] for n, found in world.true_matches().items()}
    with pytest.raises(MergeRefusedError, match="0 of 12 look alike"):
        choose(world.base_map, world.other_map, weak)
