"""Where a goal picture was taken, by what the robot finds on its way there."""

from types import SimpleNamespace

import pytest

from services.planner.goals.destination import GoalDestination
from services.planner.profiles import DEFAULT
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.local.displacement import Displacement
from tests.unit.services.planner.travel.seen import Maps, by_node, features, match
from tests.unit.shared.mapgraph.local.grid import grid

FOUND = by_node(match(0, 0.5, 0.0, 90), match(3, -1.0, 0.0, 150), match(4, 0.0, 0.0, 250))
"""The picture was taken at the last of a row of nodes, a metre apart; the first one looks like it."""


@pytest.mark.parametrize(("stands_at", "left"), [(2, {3, 4}), (4, set())])
def test_a_refuted_arrival_rules_out_what_puts_the_goal_here_and_not_all_that_is_in_view(stands_at, left):
    """Beside a fence a robot took itself to be there, two metres away: the right nodes were in view."""
    view = by_node(*(match(node, float(node - stands_at), 0.0) for node in (2, 3, 4)))
    matcher = SimpleNamespace(locate=lambda *_: dict(FOUND), match=lambda *_: dict(view))
    maps = Maps(grid(5, 1))
    goal = GoalDestination(DEFAULT, maps, matcher, features(), EdgeExperience(DEFAULT, maps), Whereabouts())
    assert set(goal.targets()) == {3, 4}
    tracker = SimpleNamespace(here=Displacement(stands_at, spread_m=0.1))
    assert goal.refutes_arrival(stands_at, 40, tracker).startswith("aliased")
    assert set(goal.targets()) == left
