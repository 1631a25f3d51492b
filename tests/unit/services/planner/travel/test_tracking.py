"""A robot does not jump: what looks alike elsewhere is not where it is."""

import itertools
import math
from types import SimpleNamespace

import numpy as np
import pytest

from services.planner.ports import Observation
from services.planner.profiles import DEFAULT, THESIS
from services.planner.travel.doubts import DOUBTS, LOOK_AROUND_M
from services.planner.travel.tracking import PATIENCE_FRAMES, Tracker
from services.planner.travel.whereabouts import APART_M, Whereabouts
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import UpdateNode
from shared.messages.sensors import Ranges
from shared.motion.motion import NO_MOTION, Motion
from tests.unit.services.planner.travel.seen import Maps, Matcher, by_node, features, match
from tests.unit.shared.mapgraph.local.grid import grid

GRAPH = grid(20, 2)
RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(4.0,) * 12, max_range_m=4.0)
HERE = by_node(match(0, 0.0, 0.0, 60), match(1, 1.0, 0.0, 50))
ELSEWHERE = by_node(match(9, 0.0, 0.0, 180), match(10, 1.0, 0.0, 120))

FRAMES = itertools.count()
TWIN = by_node(match(9, 0.0, 0.0, 80), match(10, 1.0, 0.0, 60))


@pytest.fixture
def matcher():
    return Matcher()


def tracker_of(matcher, *, certain=False, profile=DEFAULT):
    return Tracker(profile, Maps(GRAPH), matcher, certain=certain)


@pytest.fixture
def tracker(matcher):
    standing = tracker_of(matcher)
    standing.stand_at(Displacement(0, spread_m=0.1))
    drive(standing)
    return standing


def drive(tracker, moved_m=(0.12, 0.0)):
    tracker.observe(Observation(features(next(FRAMES)), RANGES, Motion(*moved_m)))


def test_a_look_alike_elsewhere_is_not_where_the_robot_is(tracker):
    assert set(tracker.possible(HERE | ELSEWHERE)) == {0, 1}


def test_while_only_look_alikes_show_it_waits_for_what_is_near(tracker):
    for _ in range(5):
        drive(tracker)
        assert tracker.possible(ELSEWHERE) == {}
    assert set(tracker.possible(HERE | ELSEWHERE)) == {0, 1}


AWAY = 9
"""So many nodes further on it looks alike."""


def seen_from(x_m, here, elsewhere):
    """The two nodes around a spot so far beyond node 0, and the two that look like them, by their matches."""
    first = int(x_m)
    sights = ((node, node - x_m, s) for node, s in zip((first, first + 1), here, strict=True))
    alike = ((first + k + AWAY, first + k - x_m, s) for k, s in enumerate(elsewhere))
    return by_node(*(match(node, ahead_m, 0.0, s) for node, ahead_m, s in (*sights, *alike)))


def after_views(tracker, here, elsewhere, *, of_map=True, way_m=LOOK_AROUND_M):
    """Whether what counts of the last of some views, so far apart, is elsewhere."""
    for number in range(1, DOUBTS + 1):
        drive(tracker, (way_m, 0.0))
        found = tracker.possible(seen_from(number * way_m, here, elsewhere), of_map=of_map)
    return {node >= AWAY for node in found}


def test_who_sees_other_places_from_here_and_there_is_not_where_it_believes_to_be(tracker):
    assert after_views(tracker, (30, 25), (180, 120)) == {True}
    assert tracker.mistaken
    drive(tracker)
    assert not tracker.mistaken, "it was said"


@pytest.mark.parametrize("elsewhere", [(60, 40), (80, 60)])
def test_a_place_that_is_among_the_likely_ones_is_where_the_robot_is(tracker, elsewhere):
    assert after_views(tracker, (60, 50), elsewhere) == {False}
    assert not tracker.mistaken


@pytest.mark.parametrize("kinds", [{"of_map": False}, {"way_m": 0.3}])
def test_nodes_on_the_way_alone_refute_nothing_nor_does_one_spot(tracker, kinds):
    assert after_views(tracker, (30, 25), (180, 120), **kinds) == {False}
    assert not tracker.mistaken


def test_one_that_maps_believes_what_it_did(matcher):
    mapping = tracker_of(matcher, certain=True)
    mapping.stand_at(Displacement(0, spread_m=0.1))
    assert after_views(mapping, (30, 25), (180, 120)) == {False}
    assert mapping.compared == 0


def test_after_some_way_the_next_view_is_compared_with_the_map(tracker):
    assert tracker.compared == 0
    drive(tracker, (LOOK_AROUND_M, 0.0))
    assert tracker.compared > 0


def test_a_match_unsure_of_its_direction_is_none_to_follow(tracker):
    unsure = match(0, 0.5, 0.0, 60).model_copy(update={"confidence": 0.2})
    assert tracker.possible(by_node(unsure)) == {}


def test_a_robot_that_was_carried_is_where_it_stands(tracker, matcher):
    matcher.inliers = 5
    drive(tracker)
    assert set(tracker.possible(ELSEWHERE)) == {9, 10}


def test_two_views_that_tell_no_direction_well_are_still_of_one_place(tracker, matcher):
    matcher.heading_std_rad = 0.2
    drive(tracker)
    assert tracker.possible(ELSEWHERE) == {}


def test_one_that_was_carried_smoothly_is_found_after_a_while(tracker):
    for _ in range(PATIENCE_FRAMES):
        drive(tracker, (0.0, 0.0))
        seen = tracker.possible(ELSEWHERE)
    assert set(seen) == {9, 10}


def test_without_history_the_likeliest_place_counts(matcher):
    assert set(tracker_of(matcher).possible(HERE | ELSEWHERE)) == {9, 10}


def test_one_that_maps_wants_to_be_certain(matcher):
    alike = by_node(match(9, 0.0, 0.0, 60), match(10, 1.0, 0.0, 50))
    assert tracker_of(matcher, certain=True).possible(HERE | alike) == {}
    assert set(tracker_of(matcher, certain=True).possible(HERE | ELSEWHERE)) == {9, 10}


@pytest.mark.parametrize("certain", [True, False], ids=["maps", "drives to a goal"])
@pytest.mark.parametrize("left", [0, 3], ids=["as the node looks", "turned right by three sectors"])
def test_one_that_maps_is_at_no_node_around_which_other_things_stand(matcher, certain, left):
    """A rib of a corrugated wall looks as the next one; goals are found after furniture was moved, too."""
    around_m = (1.2,) * 6 + (3.0,) * 6
    graph = grid(20, 2)
    graph.apply([UpdateNode(node=graph.nodes[1].model_copy(update={"echoes_m": around_m}))])
    tracker = Tracker(DEFAULT, Maps(graph), matcher, certain=certain)
    turn = left * math.tau / 12
    tracker.stand_at(Displacement(0, x_m=0.9, yaw_rad=-turn, spread_m=0.6))
    cos, sin = math.cos(turn), math.sin(turn)
    there, beside, away = (
        match(node, ahead_m * cos, ahead_m * sin, inliers).model_copy(update={"yaw_rad": turn})
        for node, ahead_m, inliers in ((1, 0.1, 300), (0, -0.9, None), (1, 0.9, None))
    )
    for reads_m, seen, possible in (
        (np.roll(around_m, left), there, True),
        (np.roll(around_m, left + 6), there, not certain),
        (np.roll(around_m, left + 6), away, True),
    ):
        ranges = RANGES.model_copy(
            update={"angles_rad": tuple(np.arange(12) * math.tau / 12), "distances_m": tuple(reads_m)}
        )
        tracker.observe(Observation(features(), ranges, Motion(0.0, 0.0)))
        assert (1 in tracker.possible(by_node(seen, beside))) == possible


def test_what_the_frame_shows_takes_over_from_what_was_driven(tracker):
    drive(tracker, (1.9, 0.0))
    spread_m = tracker.here.spread_m
    tracker.confirm(by_node(match(2, 0.2, 0.0)))
    assert tracker.here.node_id == 2
    assert tracker.here.spread_m < spread_m
    np.testing.assert_allclose((tracker.here.x_m, tracker.here.y_m), (-0.2, 0.0), atol=0.02)


def test_the_nodes_around_are_those_that_lie_there(tracker):
    for _ in range(4):
        drive(tracker, (1.0, 0.0))
    assert {4, 5, 24, 25} <= set(tracker.nearby())
    assert 0 not in tracker.nearby()


def test_the_thesis_takes_every_match(matcher):
    tracker = tracker_of(matcher, profile=THESIS)
    tracker.stand_at(Displacement(0, spread_m=0.1))
    assert set(tracker.possible(HERE | ELSEWHERE)) == {0, 1, 9, 10}
    assert tracker.nearby() == []


def test_likeness_is_a_share_of_what_two_frames_in_a_row_have_in_common(matcher):
    tracker = tracker_of(matcher)
    drive(tracker)
    assert tracker.likeness(100) == 1.0
    drive(tracker)
    assert tracker.likeness(100) == 0.5


def test_likeness_is_a_share_of_what_a_frame_from_beside_it_has_in_common_while_the_robot_stands():
    """Two frames from one spot are one picture: a goal 4 cm off had half of their matches, and was none."""
    asked = []
    tracker = tracker_of(SimpleNamespace(match=lambda _, __, targets: asked.append(targets) or {}))
    for seq, moved_m in enumerate([0.0, 0.04, 0.04, 0.0, 0.0, 0.01]):
        tracker.observe(Observation(features(seq), RANGES, Motion(moved_m)))
    tracker.likeness(100)
    ((apart,),) = asked
    assert apart.seq == 0, "9 cm back; all later ones are nearer than a hand's breadth"


def test_weak_or_doubtful_matches_do_not_say_where_it_is(matcher):
    weak = match(3, 0.0, 0.0, DEFAULT.travel.s_via_min)
    doubtful = match(5, 1.0, 0.0, 300).model_copy(update={"status": "inconsistent"})
    assert tracker_of(matcher).possible(by_node(weak, doubtful)) == {}


def test_at_the_end_of_a_way_it_knows_where_beside_the_node_it_stands(tracker):
    for _ in range(4):
        drive(tracker, (1.0, 0.0))
    around = by_node(match(4, -0.3, 0.2), match(24, -0.3, 1.2, 60), match(5, 0.7, 0.2, 60))
    here = tracker.standing_at(4, around | by_node(match(9, 0.3, 0.2, 180)))
    assert here.node_id == 4
    np.testing.assert_allclose((here.x_m, here.y_m), (0.3, -0.2), atol=0.03)
    assert here.spread_m < 0.15


def test_a_node_that_does_not_show_is_reached_all_the_same(tracker):
    here = tracker.standing_at(0, {})
    assert (here.node_id, here.length_m, here.yaw_rad) == (0, 0.0, 0.0)
    assert here.spread_m > 0.1


@pytest.mark.parametrize(("inliers", "moved"), [(60, False), (300, True)])
def test_a_node_that_hardly_shifts_is_near_only_where_its_matches_say_so_too(matcher, inliers, moved):
    """A corridor: half a metre from node 0, and node 2, 1.5 m ahead, seems to be 0.2 m away."""
    tracker = tracker_of(matcher)
    tracker.stand_at(Displacement(0, x_m=0.5, spread_m=0.3))
    tracker.confirm(by_node(match(2, 0.2, 0.0, inliers)))
    assert tracker.here.node_id == (2 if moved else 0)


@pytest.mark.parametrize(
    ("alike", "near", "shown"),
    [(200, {0}, {0, 1}), (5, {0}, {9, 10}), (200, set(), {9, 10})],
    ids=["stands there", "was carried", "the map was replaced"],
)
def test_the_next_mission_begins_where_the_last_one_ended_if_the_view_agrees(matcher, alike, near, shown):
    at = Whereabouts("flat")
    last = Tracker(DEFAULT, Maps(GRAPH), matcher, certain=False, whereabouts=at)
    last.stand_at(Displacement(0, spread_m=0.1))
    drive(last)
    new = Tracker(DEFAULT, Maps(GRAPH), matcher, certain=False, whereabouts=at.of("flat"))
    matcher.inliers, matcher.near = alike, near
    drive(new, (0.0, 0.0))
    assert set(new.possible(HERE | ELSEWHERE)) == shown


@pytest.mark.parametrize(("seen", "guessed"), [(HERE | TWIN, True), (TWIN, False)])
def test_who_finds_itself_at_one_of_several_look_alikes_knows_that_it_guessed(matcher, seen, guessed):
    at = Whereabouts("flat", guessed=not guessed)
    tracker = Tracker(DEFAULT, Maps(GRAPH), matcher, certain=False, whereabouts=at)
    drive(tracker)
    assert set(tracker.possible(seen)) == {9, 10}
    assert at.guessed == guessed


def test_a_frame_that_is_asked_for_again_is_not_the_one_before_itself():
    at, (before, now, again) = Whereabouts(), map(features, (1, 2, 2))
    for frame, moved in ((before, NO_MOTION), (now, Motion(APART_M, 0.0)), (again, NO_MOTION)):
        at.observe(frame, moved)
    assert at.before is before
    assert at.apart is before


def test_another_map_tells_nothing_of_where_the_robot_is():
    at = Whereabouts("flat", here=Displacement(0))
    assert at.of("flat") is at
    assert at.of("loft").here is None


def test_a_robot_is_not_at_a_node_that_lies_metres_away_however_alike_it_looks(tracker):
    assert not tracker.is_beyond(0)
    assert tracker.is_beyond(3)
    tracker.stand_at(Displacement(0, spread_m=1.5))
    assert not tracker.is_beyond(3), "who does not know where it is may be anywhere"
    tracker.stand_at(None)
    assert not tracker.is_beyond(3)


@pytest.mark.parametrize(("place", "known"), [(HERE, True), (ELSEWHERE, False)])
def test_a_view_of_a_place_makes_doubt_only_those_who_believe_to_be_elsewhere(tracker, place, known):
    """A goal's look-alike beside the robot was arrived at: that says nothing against where it is."""
    tracker.shown(place)
    assert (tracker.here is not None) == known
