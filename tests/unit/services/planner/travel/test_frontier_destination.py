"""The frontier to go to next; those that no path leads to: closed, or set aside where a rule may be why."""

import pytest

from services.planner.mapping.frontiers.allowed_directions import AllowedDirections
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.profiles import DEFAULT
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.frontier_destination import NEXT_M, FrontierDestination
from shared.mapgraph.frontiers import open_directions, without_frontiers
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import UpdateNode
from shared.messages.places import DeleteRule, KeepOut, PutRule
from tests.plane_world import PlaneMap
from tests.unit.shared.mapgraph.local.grid import grid

FAR = 8
"""A node with something unexplored; nobody may go to the one before it."""


@pytest.fixture
def maps():
    found = PlaneMap(grid(9, 1))
    found.commit([UpdateNode(node=found.graph.nodes[FAR].model_copy(update={"open": (True,) * 12}))])
    return found


def without_path(maps):
    """What is left to explore after as many frames as it takes to give it up, and what was told."""
    experience = EdgeExperience(DEFAULT, maps)
    destination = FrontierDestination(
        DEFAULT, maps, None, experience, AllowedDirections(maps), FloorViews(0.27)
    )
    kinds = []
    for _ in range(DEFAULT.mapping.saturation_steps):
        kinds += [note.kind for note in destination.no_path().notes]
    return destination.targets(), kinds


def test_without_rules_they_are_closed(maps):
    assert without_path(maps) == ({}, ["nodes_unreachable"])
    assert open_directions(maps.graph) == 0


def test_behind_a_rule_they_are_set_aside_and_there_again_when_it_is_lifted(maps):
    maps.commit([PutRule(rule=KeepOut(name="shut", nodes=(FAR - 4,)))])
    assert without_path(maps) == ({}, ["nodes_set_aside"])
    assert open_directions(maps.graph) == 12
    maps.commit([DeleteRule(name="shut")])
    experience = EdgeExperience(DEFAULT, maps)
    again = FrontierDestination(DEFAULT, maps, None, experience, AllowedDirections(maps), FloorViews(0.27))
    assert again.targets() == {FAR: 0.0}


def test_the_next_frontier_is_where_much_floor_comes_early_and_the_nearest_for_who_is_lost(maps):
    near, here = 3, 4
    maps.commit([UpdateNode(node=maps.graph.nodes[near].model_copy(update={"open": (True,) * 12}))])
    views = FloorViews(0.27)
    views.gains = {near: 0.1, FAR: 1.0}
    experience = EdgeExperience(DEFAULT, maps)
    destination = FrontierDestination(DEFAULT, maps, None, experience, AllowedDirections(maps), views)
    assert destination.choose(Displacement(here))
    assert destination.targets() == {near: NEXT_M, FAR: 0.0}
    assert destination.choose(None)
    assert destination.targets() == {near: 0.0, FAR: 0.0}
    maps.commit([UpdateNode(node=without_frontiers(maps.graph.nodes[n])) for n in (near, FAR)])
    assert not destination.choose(Displacement(here))


def test_the_next_frontier_is_one_that_the_rules_and_what_failed_leave_a_way_to(maps):
    near, here = 2, 4
    maps.commit([UpdateNode(node=maps.graph.nodes[near].model_copy(update={"open": (True,) * 12}))])
    views = FloorViews(0.27)
    views.gains = {near: 1.0, FAR: 1.0}
    experience = EdgeExperience(DEFAULT, maps)
    destination = FrontierDestination(DEFAULT, maps, None, experience, AllowedDirections(maps), views)

    def chosen():
        assert destination.choose(Displacement(here))
        return next(node for node, more_m in destination.targets().items() if not more_m)

    assert chosen() == near
    maps.commit([PutRule(rule=KeepOut(name="shut", nodes=(near + 1,)))])
    assert chosen() == FAR
    maps.commit([DeleteRule(name="shut")])
    experience.banned.add((near, near + 1))
    assert chosen() == FAR
