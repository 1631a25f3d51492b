"""What is seen of waypoints ahead, and whether a robot stands at one."""

from types import SimpleNamespace

import pytest

from services.planner.profiles import DEFAULT
from services.planner.travel.following.lookahead import Lookahead
from services.planner.travel.following.waypoints import is_at
from services.planner.travel.tracking import Tracker
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.local.view_range import openness
from shared.mapgraph.routing import GOAL
from shared.messages.matching import NodeMatch
from tests.unit.services.planner.travel.seen import Maps, Matcher, features
from tests.unit.shared.mapgraph.local.places import row

NODE = 10
STREET = MapGraph(*row(20, 1.2))


def stands(here, **seen):
    match = NodeMatch(node_id=NODE, status="no_baseline", raw_matches=80, inliers=60, yaw_rad=0.0).model_copy(
        update=seen
    )
    assert not is_at(match, STREET, DEFAULT), "too few matches to tell near from far by themselves"
    maps = Maps(STREET)
    tracker = Tracker(DEFAULT, maps, Matcher(), certain=False)
    tracker.stand_at(here)
    return Lookahead(DEFAULT, maps, SimpleNamespace(), set(), tracker).is_at(NODE, match)


def test_who_came_to_a_node_and_sees_no_baseline_is_there_though_the_sun_took_half_of_the_matches():
    """It drove through the node, turned, and drove through it again, for 137 frames."""
    assert openness(STREET, NODE) > 2.0
    assert stands(Displacement(NODE, x_m=0.2, spread_m=0.6))


@pytest.mark.parametrize(
    ("here", "seen"),
    [
        (None, {}),
        (Displacement(NODE, x_m=1.5, spread_m=0.3), {}),
        (Displacement(NODE, spread_m=3.0), {}),
        (Displacement(NODE, spread_m=0.3), {"inliers": 5}),
        (Displacement(NODE, spread_m=0.3), {"status": "ok", "disparity_rad": 0.05, "heading_rad": 0.0}),
    ],
    ids=["lost", "further on", "perhaps", "hardly alike", "ahead"],
)
def test_without_that_it_is_not(here, seen):
    assert not stands(here, **seen)


@pytest.mark.parametrize("may_be_it", [True, False])
def test_a_goal_in_sight_that_cannot_be_it_is_not_seen(may_be_it):
    maps = Maps(STREET)
    tracker = Tracker(DEFAULT, maps, Matcher(), certain=False)
    destination = SimpleNamespace(picture=features(), sees=lambda _goal, _here: may_be_it)
    goal = NodeMatch(node_id=GOAL, status="ok", raw_matches=80, inliers=60, heading_rad=0.0, yaw_rad=0.0)
    matcher = SimpleNamespace(match=lambda _nodes, _best_k, _pictures: {GOAL: goal})
    seen = Lookahead(DEFAULT, maps, destination, set(), tracker).compare([NODE, GOAL], matcher)
    assert (GOAL in seen) == may_be_it
