"""At a waypoint: which leg is driven on, and for which another way is asked for."""

import math
from types import SimpleNamespace

import pytest

from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.following.path_follower import PathFollower
from services.planner.travel.following.patience import NEAREST_STEPS, STUCK_STEPS
from services.planner.travel.states import Event
from services.planner.travel.tracking import Tracker
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.mapgraph.routing import GOAL
from shared.messages.base import SECTORS
from shared.messages.maps import Node, PutEdge
from shared.messages.sensors import Ranges
from shared.motion.motion import Motion
from tests.unit.services.planner.travel.seen import Maps, Matcher, by_node, features, match
from tests.unit.shared.mapgraph.local.grid import edge, grid

ANGLES_RAD = tuple(math.radians(30.0 * sector) for sector in range(SECTORS))
AT_THE_WAYPOINT = by_node(match(0, 0.0, 0.0, 120), match(1, 2.0, 0.0, 37))
"""The next node lies 2 m ahead, by its matches in a room."""


class Seen:
    def match(self, node_ids, best_k=0, targets=()):  # noqa: ARG002
        return {node: AT_THE_WAYPOINT[node] for node in node_ids}


def event_before(free_m, **leg):
    """What a robot at the first of two waypoints decides, with so much free ground all round."""
    joined = edge(0, 1, 2, driven=False).model_copy(update=leg)
    maps = Maps(MapGraph([Node(node_id=0), Node(node_id=1)], [joined]))
    tracker = Tracker(DEFAULT, maps, Seen(), certain=False)
    to_a_node = SimpleNamespace(picture=None, arrival_rad=0.0, aliased=False, cuts_corners=True)
    experience = EdgeExperience(DEFAULT, maps)
    follower = PathFollower(DEFAULT, maps, [0, 1], to_a_node, set(), experience, tracker)
    ranges = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(free_m + 0.3,) * SECTORS, max_range_m=4.0)
    return follower.step(Observation(features(), ranges), Seen())[0], follower.position.index


def test_past_a_waypoint_where_something_stands_it_goes_to_the_next_one_on_the_second_try():
    """A door was left open: its leaf stands where the node was, half a metre ahead."""
    maps = Maps(grid(4, 1))
    maps.graph.apply([PutEdge(edge=maps.graph.edge(0, 1).model_copy(update={"failures": 1}))])
    tracker = Tracker(DEFAULT, maps, Matcher(), certain=False)
    tracker.stand_at(Displacement(0, x_m=0.5, spread_m=0.1))
    to_a_node = SimpleNamespace(picture=features(), arrival_rad=0.0, aliased=False, cuts_corners=True)
    experience = EdgeExperience(DEFAULT, maps)
    follower = PathFollower(DEFAULT, maps, [0, 1, 2], to_a_node, set(), experience, tracker)
    follower.position.index = 1
    ranges = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(0.4,) * SECTORS, max_range_m=4.0)
    seen = SimpleNamespace(match=lambda *_, **__: by_node(match(1, 0.5, 0.0, 100)))
    _, decision = follower.step(Observation(features(), ranges), seen)
    assert (follower.position.index, decision.action, decision.method) == (2, "go", "reckoned")


def test_a_waypoint_that_something_stands_on_is_given_up_where_the_map_alone_does_not_lead_on():
    """On the way to a frontier, say."""
    maps = Maps(grid(4, 1))
    maps.graph.apply([PutEdge(edge=maps.graph.edge(0, 1).model_copy(update={"failures": 1}))])
    tracker = Tracker(DEFAULT, maps, Matcher(), certain=False)
    to_a_node = SimpleNamespace(picture=None, arrival_rad=0.0, aliased=False, cuts_corners=True)
    experience = EdgeExperience(DEFAULT, maps)
    follower = PathFollower(DEFAULT, maps, [0, 1, 2], to_a_node, set(), experience, tracker)
    follower.position.index = 1
    ranges = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(0.4,) * SECTORS, max_range_m=4.0)
    seen = SimpleNamespace(match=lambda *_, **__: by_node(match(1, 0.5, 0.0, 100)))
    events = [follower.step(Observation(features(), ranges), seen)[0] for _ in range(STUCK_STEPS + 2)]
    assert events[-1] is Event.NO_PROGRESS


def last_event(views):
    """What becomes of a robot that sees the goal so, frame by frame, and heads for it."""
    maps = Maps(MapGraph([Node(node_id=0)], []))
    tracker = Tracker(DEFAULT, maps, Seen(), certain=False)
    goal = SimpleNamespace(
        picture=features(),
        arrival_rad=DEFAULT.arrival.arrival_rad,
        aliased=False,
        cuts_corners=True,
        sees=lambda *_: True,
    )
    follower = PathFollower(DEFAULT, maps, [GOAL], goal, set(), EdgeExperience(DEFAULT, maps), tracker)
    ranges = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(3.0,) * SECTORS, max_range_m=4.0)
    for view in views:
        seen = SimpleNamespace(match=lambda *_, **__: {GOAL: view})  # noqa: B023
        event, _ = follower.step(Observation(features(), ranges), seen)
    return event


STEPS = NEAREST_STEPS + 2


def test_a_goal_that_comes_no_nearer_is_as_near_as_obstacles_allow():
    assert last_event([match(GOAL, 0.3, 0.0, 110 + step % 2) for step in range(STEPS)]) is Event.REACHED


def test_a_goal_that_shows_ever_better_comes_nearer_though_disparity_stays():
    assert last_event([match(GOAL, 0.3, 0.0, 110 + 4 * step) for step in range(STEPS)]) is None


def test_a_leg_never_driven_nor_seen_free_is_doubted_where_ground_is_free_for_half_of_it():
    assert event_before(1.2) == (Event.WAY_UNCLEAR, 0)


@pytest.mark.parametrize("known", [{"clear": True}, {"traversals": 1}])
def test_a_leg_driven_or_seen_free_before_is_driven_on_then(known):
    assert event_before(1.2, **known) == (None, 1)


def test_a_leg_seen_free_before_that_is_shut_now_is_doubted_again():
    assert event_before(0.4, clear=True) == (Event.WAY_UNCLEAR, 0)


def test_any_leg_that_is_seen_free_is_driven_on():
    assert event_before(3.0) == (None, 1)


def test_a_goal_that_does_not_show_from_the_last_node_is_headed_for_by_the_map():
    """It lies two metres to the left of the node, hidden there by what stands beside it."""
    maps = Maps(MapGraph([Node(node_id=0), Node(node_id=1)], [edge(0, 1, 2)]))
    tracker = Tracker(DEFAULT, maps, Seen(), certain=False)
    tracker.stand_at(Displacement(0, spread_m=0.1))
    goal = SimpleNamespace(
        picture=features(), arrival_rad=0.01, aliased=False, cuts_corners=True, sees=lambda *_: True,
        lies=lambda _: Displacement(0, y_m=2.0),
    )  # fmt: skip
    experience, unclear = EdgeExperience(DEFAULT, maps), {(GOAL, 0)}
    follower = PathFollower(DEFAULT, maps, [0, GOAL], goal, unclear, experience, tracker)
    ranges = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(3.0,) * SECTORS, max_range_m=4.0)
    seen = SimpleNamespace(match=lambda *_, **__: by_node(match(0, 0.0, 0.0, 200), match(GOAL, 0.0, 2.0, 8)))
    found = [follower.step(Observation(features(), ranges), seen) for _ in range(20)]
    blind = [decision for _, decision in found if decision.method == "reckoned"]
    assert blind
    assert math.degrees(blind[0].heading_rad) == pytest.approx(90.0, abs=1.0)
    assert all(event is None for event, _ in found)


def blind_steps(shows, path, free_m=3.0, steps=16, *, tried_again=False):
    """What a robot at the first node of a row decides that sees of the nodes ahead those that show."""
    maps = Maps(grid(4, 1))
    experience = EdgeExperience(DEFAULT, maps)
    experience.tried_again = tried_again
    tracker = Tracker(DEFAULT, maps, Matcher(), certain=False)
    tracker.stand_at(Displacement(0, spread_m=0.1))
    goal = SimpleNamespace(
        picture=features(), arrival_rad=0.01, aliased=False, cuts_corners=True, sees=lambda *_: True,
        lies=lambda _: Displacement(3, x_m=1.0),
    )  # fmt: skip
    follower = PathFollower(DEFAULT, maps, [*path, GOAL], goal, set(), experience, tracker)
    ranges = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(free_m,) * SECTORS, max_range_m=4.0)
    x_m, decisions, event = 0.0, [], None
    while event is None and len(decisions) < steps:
        seen = by_node(*(match(node, node - x_m, 0.0, 200) for node in shows if abs(node - x_m) < 0.5))
        matcher = SimpleNamespace(match=lambda *_, seen=seen, **__: dict(seen))
        event, decision = follower.step(Observation(features(), ranges), matcher)
        step_m = 0.12 if decision.action == "go" else 0.0
        x_m += step_m * math.cos(decision.heading_rad)
        tracker.observe(Observation(features(), ranges, moved=Motion(step_m)))
        decisions.append(decision)
    return event, follower, decisions


def test_a_node_that_does_not_show_from_the_one_before_is_headed_for_by_the_map():
    """Furniture moved behind a door: from there the next room looks like another one."""
    event, follower, found = blind_steps([0], [0, 1, 2])
    assert event is None
    assert [one.method for one in found].count("reckoned") > 2
    assert follower.position.index == 1
    assert found[-1].heading_rad == pytest.approx(0.0, abs=0.1)


def test_where_the_way_is_shut_a_node_that_does_not_show_is_not_headed_for():
    event, follower, found = blind_steps([0], [0, 1, 2], free_m=0.5)
    assert event is Event.NO_PROGRESS
    assert follower.failed_edge() == ((0, 1), 1)
    assert all(one.action == "hold" for one in found)


def test_where_no_other_way_is_left_it_goes_round_what_shuts_the_one_there_is():
    event, _, found = blind_steps([0], [0, 1, 2], free_m=0.5, tried_again=True)
    assert event is None
    assert "reckoned" in [one.method for one in found]


def test_past_where_the_map_has_it_the_next_one_is_headed_for_and_at_last_the_path_is_lost():
    """Forty frames in all."""
    _, follower, found = blind_steps([0], [0, 1, 2], steps=24)
    assert follower.position.index == 2
    event, follower, found = blind_steps([0], [0, 1, 2], steps=200)
    assert event is Event.WAYPOINT_LOST
    assert len(found) < 70


def test_the_nodes_around_are_compared_beside_those_ahead():
    """Ahead a corridor whose doors repeat looks the same one door further; around the robot it does not."""
    maps, asked = Maps(grid(12, 1)), []
    tracker = Tracker(DEFAULT, maps, Seen(), certain=False)
    tracker.stand_at(Displacement(2, x_m=0.2, spread_m=0.1))
    to_a_node = SimpleNamespace(picture=None, arrival_rad=0.0, aliased=False, cuts_corners=True)
    experience, path = EdgeExperience(DEFAULT, maps), [6, 7, 8, 9]
    follower = PathFollower(DEFAULT, maps, path, to_a_node, set(), experience, tracker)
    seen = SimpleNamespace(match=lambda nodes, *_: asked.extend(nodes) or {})
    ranges = Ranges(robot="r1", angles_rad=ANGLES_RAD, distances_m=(3.0,) * SECTORS, max_range_m=4.0)
    follower.step(Observation(features(), ranges), seen)
    assert asked == [6, 7, 8, 9, 2, 3, 1]
