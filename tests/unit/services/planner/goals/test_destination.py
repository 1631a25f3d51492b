"""Where a goal picture was taken, by what the robot finds on its way there."""

from types import SimpleNamespace

import pytest

from services.planner.goals.destination import GoalDestination
from services.planner.profiles import DEFAULT
from services.planner.travel.edge_experience import EdgeExperience
from services.planner.travel.tracking import Tracker
from services.planner.travel.whereabouts import Whereabouts
from shared.mapgraph.local.displacement import Displacement
from tests.unit.services.planner.travel.seen import Maps, by_node, features, match
from tests.unit.shared.mapgraph.local.grid import grid

FOUND = by_node(match(0, 0.5, 0.0, 90), match(3, -1.0, 0.0, 150), match(4, 0.0, 0.0, 250))
"""The picture was taken at the last of a row of nodes, a metre apart; the first one looks like it."""


@pytest.mark.parametrize(
    ("stands_at", "believes", "left"),
    [(2, 2, {3, 4}), (4, 4, set()), pytest.param(0, 4, {3, 4}, id="is not where it believes to be")],
)
def test_a_refuted_arrival_rules_out_what_puts_the_goal_here_and_not_all_that_is_in_view(
    stands_at, believes, left
):
    """Beside a fence a robot took itself to be there, two metres away: the right nodes were in view."""
    in_view = range(5) if stands_at == 0 else (2, 3, 4)
    view = by_node(*(match(node, float(node - stands_at), 0.0) for node in in_view))
    matcher = SimpleNamespace(locate=lambda *_: dict(FOUND), match=lambda *_: dict(view))
    maps = Maps(grid(5, 1))
    goal = GoalDestination(DEFAULT, maps, matcher, features(), EdgeExperience(DEFAULT, maps), Whereabouts())
    assert set(goal.targets()) == {3, 4}
    tracker = Tracker(DEFAULT, maps, matcher, certain=False)
    tracker.stand_at(Displacement(believes, spread_m=0.1))
    assert goal.refutes_arrival(believes, 40, tracker).startswith("aliased")
    assert set(goal.targets()) == left
    assert tracker.mistaken == (believes != stands_at)
