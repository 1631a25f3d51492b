"""The last metre to a photo's place: gone while it is free, then turned; where it is shut it ends."""

import math

import numpy as np
import pytest

from services.planner.photographs.last_metre import LEG_STEPS, TURN_STEPS, LastMetre
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.photographs.search import PhotoPlace
from shared.messages.maps import Node
from shared.messages.sensors import Ranges
from shared.motion.motion import Motion
from tests.plane_world import PlaneMap, picture

AHEAD_M, LOOKS_RAD = 0.8, 1.0
STEP = Motion(0.1, 0.0)


class Blind:
    """Sees nothing that it knows: where the robot is, only its motions tell."""

    def match(self, _node_ids, _best_k=0, _targets=()):
        return {}


@pytest.fixture
def last_metre():
    place = PhotoPlace(0, AHEAD_M, 0.0, 0.1, LOOKS_RAD, 1.2, 90.0, 30)
    return LastMetre(DEFAULT, PlaneMap(MapGraph([Node(node_id=0)])), Blind(), place)


def observed(moved, free_m=3.0):
    angles = tuple(np.arange(12) * math.tau / 12)
    ranges = Ranges(robot="r1", angles_rad=angles, distances_m=(free_m,) * 12, max_range_m=5.0)
    return Observation(picture((0.0, 0.0, 0.0)), ranges, moved)


def test_the_robot_goes_to_the_spot_and_turns_to_what_the_photo_shows(last_metre):
    first = last_metre.decide(observed(Motion()))
    assert (first.action, first.heading_rad, first.distance_m) == ("go", 0.0, pytest.approx(AHEAD_M))
    decisions = [last_metre.decide(observed(STEP)) for _ in range(6)]
    assert [one.action for one in decisions] == ["go"] * 5 + ["hold"]
    assert decisions[-1].face_rad == pytest.approx(LOOKS_RAD)
    assert decisions[-1].outcome == ""
    turned = last_metre.decide(observed(Motion(0.0, 0.0, 0.98)))
    assert (turned.outcome, turned.face_rad) == ("succeeded", None)
    assert turned.why.startswith("where the photo was taken")


def test_where_nothing_free_leads_on_the_robot_turns_where_it_is(last_metre):
    assert last_metre.decide(observed(Motion())).action == "go"
    shut = last_metre.decide(observed(STEP, free_m=0.25))
    assert (shut.action, shut.face_rad) == ("hold", pytest.approx(LOOKS_RAD))
    assert last_metre.decide(observed(Motion())).action == "hold"


def test_a_robot_that_comes_no_nearer_and_cannot_turn_ends_and_says_where_it_is_and_how_it_looks(last_metre):
    decisions = [last_metre.decide(observed(Motion())) for _ in range(int(LEG_STEPS) + TURN_STEPS + 2)]
    ended = [one for one in decisions if one.outcome]
    assert {one.outcome for one in ended} == {"succeeded"}
    assert decisions.index(ended[0]) >= TURN_STEPS
    told = "0.8 m from where the photo was taken, 57 degrees from the photo's direction"
    assert {one.why for one in ended} == {told}
