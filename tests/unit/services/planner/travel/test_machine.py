"""The travel machine takes only transitions of its table, and each state shows on a true floor plan."""

import math

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.goals.destination import GoalDestination
from services.planner.missions.explore import FrontierExploration
from services.planner.missions.goto import Goto
from services.planner.profiles import DEFAULT
from services.planner.travel.destination import Verdict
from services.planner.travel.following.patience import Patience
from services.planner.travel.states import TRANSITIONS, Event, State
from services.planner.travel.whereabouts import Whereabouts
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld, picture, run

START = (2.6, 1.3, 0.0)
HALL = (-0.2, -3.0, 0.0)


@pytest.fixture(scope="module")
def mapped(explorations):
    found = explorations(2)
    return found.world, found.maps


def states_of(mission, world, steps, before=lambda _step: None):
    """The states told frame by frame, without repetitions, and the last decision."""
    told = []
    for step in range(steps):
        before(step)
        decision, _ = run(world, mission, DriveLimits(), 1)
        progress = mission.progress
        if not told or told[-1][0] != progress.travel:
            told.append((progress.travel, progress.travel_reason))
        if decision.outcome:
            break
    return [state for state, _ in told], dict(told), decision


def test_a_drive_without_trouble_follows_and_arrives(mapped):
    world, maps = mapped
    world.pose = START
    mission = Goto(DEFAULT, maps, PlaneMatcher(world, maps), picture(HALL))
    states, reasons, decision = states_of(mission, world, 600)
    assert states[-1] == "arrived"
    assert set(states) <= {"following", "localising", "arrived"}
    assert decision.outcome == "succeeded"
    assert reasons["arrived"] == TRANSITIONS[State.FOLLOWING, Event.REACHED].reason
    assert math.dist(world.pose[:2], HALL[:2]) < 0.35


def test_a_robot_that_loses_everything_searches_and_then_finds_its_way_again(mapped):
    world, maps = mapped
    world.pose = START
    matcher = PlaneMatcher(world, maps)
    mission = Goto(DEFAULT, maps, matcher, picture(HALL))

    def blind(step):
        matcher.blind = 6 <= step < 36

    states, reasons, decision = states_of(mission, world, 1500, blind)
    assert states.index("searching") < len(states) - 1 - states[::-1].index("following")
    assert reasons["searching"] == TRANSITIONS[State.LOCALISING, Event.NOTHING_KNOWN].reason
    assert decision.outcome == "succeeded"


def test_a_robot_that_never_finds_anything_again_fails_as_lost(mapped):
    world, maps = mapped
    world.pose = START
    matcher = PlaneMatcher(world, maps)
    mission = Goto(DEFAULT, maps, matcher, picture(HALL))

    def blind(step):
        matcher.blind = step >= 1

    states, _, decision = states_of(mission, world, 1000, blind)
    assert states[-2:] == ["searching", "failed"]
    assert (decision.outcome, decision.failure) == ("failed", "lost")


def sees_no_node(self, _nodes, _best_k=0, targets=(), match=PlaneMatcher.match):
    return match(self, [], 0, targets)


def test_who_is_lost_asks_the_map_the_next_time(mapped, monkeypatch):
    """One went on believing to be 20 m further along a street, mission after mission."""
    world, maps = mapped
    world.pose = START
    where = Whereabouts()
    mission = Goto(DEFAULT, maps, PlaneMatcher(world, maps), picture(HALL), where)
    run(world, mission, DriveLimits(), 5)
    assert where.here is not None
    monkeypatch.setattr(PlaneMatcher, "match", sees_no_node)
    monkeypatch.setattr(Patience, "goes_on_blind", lambda _: False)
    monkeypatch.setattr(GoalDestination, "setback", lambda *_: Verdict(failure="lost"))
    decision, _ = run(world, mission, DriveLimits(), 30)
    assert (decision.failure, where.here) == ("lost", None)


def test_who_sees_no_node_any_more_arrives_by_where_the_map_has_them(mapped, monkeypatch):
    world, maps = mapped
    world.pose = START
    mission = Goto(DEFAULT, maps, PlaneMatcher(world, maps), picture(HALL), Whereabouts())
    run(world, mission, DriveLimits(), 5)
    monkeypatch.setattr(PlaneMatcher, "match", sees_no_node)
    decision, _ = run(world, mission, DriveLimits(), 150)
    assert decision.outcome == "succeeded"
    assert math.dist(world.pose[:2], HALL[:2]) < 0.2


def test_exploration_travels_by_the_same_machine():
    world, maps = PlaneWorld(START, np.random.default_rng(5)), PlaneMap()
    mission = FrontierExploration(DEFAULT, maps, PlaneMatcher(world, maps), np.random.default_rng(5))
    states, _, _ = states_of(mission, world, 400)
    assert {"following", "arrived"} <= set(states)
