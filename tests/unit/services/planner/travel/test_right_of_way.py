"""A robot that travels asks before it drives on, waits where it has to, and makes room when told."""

import math

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.missions.goto import Goto
from services.planner.ports import RightOfWay
from services.planner.profiles import DEFAULT
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.local.displacement import Displacement
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, picture, run


class Guarded(PlaneMap):
    """The map, and somebody who says how far the robot may go."""

    def __init__(self, maps):
        super().__init__(maps.graph, maps.poses, shared=True)
        self.asked, self.most, self.room = [], math.inf, ()

    def right_of_way(self, at, ahead):
        self.asked.append((at, ahead))
        return RightOfWay(int(min(self.most, len(ahead))), "r2 goes first", self.room)


@pytest.fixture
def drive(explorations):
    """A robot on its way from one end of the apartment to the other."""
    found = explorations(2)
    nodes = sorted(found.maps.poses, key=lambda node: found.maps.poses[node][:2])
    maps = Guarded(found.maps)
    start, goal = maps.poses[nodes[0]], maps.poses[nodes[-1]]
    world = PlaneWorld(start, np.random.default_rng(3), found.world.space)
    whereabouts = Whereabouts("flat", Displacement(nodes[0]))
    mission = Goto(DEFAULT, maps, PlaneMatcher(world, maps), picture(goal), whereabouts)
    return world, maps, mission


def test_it_asks_for_the_nodes_of_its_way_in_order_and_says_where_it_is(drive):
    world, maps, mission = drive
    decision, _ = run(world, mission, DriveLimits(), 800)
    assert decision.outcome == "succeeded"
    first_at, first_ahead = maps.asked[0]
    last_at, last_ahead = maps.asked[-1]
    assert len(first_at) == 1
    assert math.dist(maps.poses[first_at[-1]][:2], maps.poses[first_ahead[0]][:2]) < 2.5
    assert last_ahead == ()
    assert max(len(at) for at, _ in maps.asked) <= 4  # what lies behind is given back
    assert last_at[-1] == first_ahead[-1]
    assert all(node in maps.poses for at, ahead in maps.asked for node in (*at, *ahead))


def test_what_it_is_not_granted_it_does_not_drive_to(drive):
    world, maps, mission = drive
    maps.most = 0
    at = world.pose
    decision, _ = run(world, mission, DriveLimits(), 30)
    assert decision.why == "waits: r2 goes first"
    assert math.dist(world.pose[:2], at[:2]) < 0.05
    maps.most = math.inf
    decision, _ = run(world, mission, DriveLimits(), 800)
    assert decision.outcome == "succeeded"


def test_it_stops_at_the_last_node_that_it_was_granted(drive):
    world, maps, mission = drive
    run(world, mission, DriveLimits(), 2)
    _, ahead = maps.asked[-1]
    granted = ahead[:3]
    path = []
    for _ in range(300):
        _, now = maps.asked[-1]
        maps.most = sum(node in granted for node in now)
        decision, _ = run(world, mission, DriveLimits(), 1, path)
    assert decision.action == "hold"
    assert "go first" in decision.why or "goes first" in decision.why
    spots = [maps.poses[node][:2] for node in granted]
    assert min(math.dist(world.pose[:2], spot) for spot in spots) < 0.5
    beyond = maps.poses[ahead[4]][:2]
    assert min(math.dist(pose[:2], beyond) for pose in path) > 0.3


def test_it_makes_room_when_told_and_goes_on_from_there(drive):
    world, maps, mission = drive
    run(world, mission, DriveLimits(), 2)
    at, _ = maps.asked[-1]
    refuge = maps.graph.nearest(at[-1], 8)[-1]
    spot, made_room = maps.poses[refuge][:2], False
    maps.room = (at[-1], refuge)
    for _ in range(800):
        decision, _ = run(world, mission, DriveLimits(), 1)
        if not made_room and mission.progress.travel_reason.startswith("it is out of the way"):
            made_room, maps.room = True, ()
            assert math.dist(world.pose[:2], spot) < 0.5
        if decision.outcome:
            break
    assert made_room
    assert decision.outcome == "succeeded"
