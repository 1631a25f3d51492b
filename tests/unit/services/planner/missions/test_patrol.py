"""A patrol on the true floor plan: places in order, round by round, and what becomes of those missed."""

import json
import math
from dataclasses import dataclass

import numpy as np
import pytest

from services.drive.limits import DriveLimits
from services.planner.mission_kinds import MissionContext, MissionError, mission_kinds
from services.planner.missions.patrol import TOLD, Checkpoint, Patrol, PatrolParameters
from services.planner.ports import Decision, Progress
from services.planner.profiles import DEFAULT
from shared.messages.places import KeepOut, Place, PutPlace, PutRule
from tests.plane_world import PlaneMatcher, picture, run

PLACES = ("kitchen", "bath", "door")


class Flat:
    """A robot in the explored apartment with three places far apart."""

    def __init__(self, explored):
        assert explored.decision.outcome == "succeeded"
        self.world, self.maps = explored.world, explored.maps
        self.matcher = PlaneMatcher(self.world, self.maps)
        chosen = [next(iter(self.maps.graph.nodes))]
        while len(chosen) < len(PLACES):
            chosen.append(max(self.maps.graph.nodes, key=lambda n: min(self._apart(n, c) for c in chosen)))
        self.nodes = dict(zip(PLACES, chosen, strict=True))
        for name, node in self.nodes.items():
            self.maps.commit([PutPlace(place=Place(name=name, nodes=(node,)))])
        self.maps.features_of = lambda node: picture(self.maps.poses[node])

    def _apart(self, one, other):
        return math.dist(self.maps.poses[one][:2], self.maps.poses[other][:2])

    def patrol(self, checkpoint=None, **parameters):
        context = MissionContext(
            DEFAULT, self.maps, self.matcher, np.random.default_rng(0), checkpoint=checkpoint or {}
        )
        return mission_kinds()["patrol"].start(context, parameters)

    def near(self, pose):
        """The places within a third of a metre of a pose."""
        return [name for name, n in self.nodes.items() if math.dist(self.maps.poses[n][:2], pose[:2]) < 0.33]


@pytest.fixture(scope="module")
def flat(explorations):
    return Flat(explorations(3))


@pytest.fixture
def free(flat):
    """The flat, and its rules forgotten afterwards."""
    yield flat
    flat.maps.graph.rules.clear()


class Watched:
    """A patrol with what became of each visit and where the robot stood then."""

    def __init__(self, flat, patrol):
        self.flat, self.patrol, self.visits, self.poses, self.stood_at = flat, patrol, [], [], []

    @property
    def progress(self):
        return self.patrol.progress

    def decide(self, observation):
        decision = self.patrol.decide(observation)
        if decision.why.startswith("staying"):
            self.stood_at.append(self.flat.near(self.flat.world.pose))
        for note in decision.notes:
            if note.kind in ("visited", "missed"):
                stands_at = self.flat.near(self.flat.world.pose)
                self.visits.append((note.kind, note.values["place"], stands_at))
                self.poses.append(self.flat.world.pose)
        return decision


def test_every_place_is_driven_to_in_order_in_each_round(free):
    watched = Watched(free, free.patrol(places=PLACES, rounds=2))
    decision, _ = run(free.world, watched, DriveLimits(), 5000)
    assert (decision.outcome, decision.why) == ("succeeded", "all 6 visits made")
    assert watched.visits == [("visited", name, [name]) for name in PLACES * 2]
    figures = watched.progress.figures
    assert (figures["visited"], figures["missed"]) == (6, 0)


def test_the_robot_stays_at_a_place_for_as_long_as_it_is_told(free):
    for frames in (0, 40):
        watched = Watched(free, free.patrol(places=["door", "bath"], dwell_s=frames * 1e-9))
        assert run(free.world, watched, DriveLimits(), 3000)[0].outcome == "succeeded"
        stood = [watched.stood_at.count(free.near(watched.poses[visit])) for visit in range(2)]
        assert stood == [max(frames - 1, 0)] * 2


def test_a_place_forbidden_on_the_way_is_left_out_and_told_by_the_name_of_the_rule(free):
    watched = Watched(free, free.patrol(places=PLACES))
    free.maps.commit([PutRule(rule=KeepOut(name="wet floor", nodes=(free.nodes["bath"],)))])
    decision, _ = run(free.world, watched, DriveLimits(), 5000)
    assert (decision.outcome, decision.failure) == ("failed", "forbidden")
    assert decision.why == "2 of 3 visits made, missed: bath (forbidden)"
    assert [kind for kind, _, _ in watched.visits] == ["visited", "missed", "visited"]
    assert watched.visits[2][2] == ["door"]


def test_a_planner_that_takes_over_goes_on_with_the_place_under_way(free):
    first = Watched(free, free.patrol(places=PLACES))
    while len(first.visits) < 2:
        run(free.world, first, DriveLimits(), 1)
    kept = json.loads(json.dumps(first.progress.checkpoint))
    second = Watched(free, free.patrol(checkpoint=kept, places=PLACES))
    decision, _ = run(free.world, second, DriveLimits(), 5000)
    assert decision.why == "all 3 visits made"
    assert second.visits == [("visited", "door", ["door"])]


def test_a_planner_that_takes_over_leaves_out_what_was_forbidden_meanwhile(free):
    kept = free.patrol(places=PLACES).progress.checkpoint
    free.maps.commit([PutRule(rule=KeepOut(name="wet floor", nodes=(free.nodes["bath"],)))])
    decision, _ = run(free.world, free.patrol(checkpoint=kept, places=PLACES), DriveLimits(), 5000)
    assert decision.why == "2 of 3 visits made, missed: bath (forbidden)"
    with pytest.raises(MissionError, match="forbidden by rule 'wet floor'"):
        free.patrol(places=PLACES)


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({}, "places: Field required"),
        ({"places": []}, "places: Tuple should have at least 1 item"),
        ({"places": ["door"], "rounds": -1}, "rounds: Input should be greater than or equal to 0"),
        ({"places": ["door"], "speed": 2}, "speed: Extra inputs are not permitted"),
        ({"places": ["door", "kitchn"]}, "kitchen"),
    ],
)
def test_what_cannot_be_patrolled_is_refused_before_anything_moves(flat, parameters, words):
    with pytest.raises(MissionError, match=words):
        flat.patrol(**parameters)


@dataclass
class Leg:
    """A way that ends at once."""

    failure: str = ""
    progress = Progress()

    def decide(self, _observation):
        outcome = "failed" if self.failure else "succeeded"
        return Decision("hold", why="as told", outcome=outcome, failure=self.failure)


def test_a_patrol_without_an_end_goes_on_whatever_it_misses(flat):
    patrol = Patrol(PatrolParameters(places=("far",), rounds=0), lambda _: Leg("blocked"))
    for _ in range(100):
        assert not patrol.decide(flat.world.observe()).outcome
    kept = Checkpoint.model_validate(patrol.progress.checkpoint)
    assert (kept.visit, kept.missed_in_all, len(kept.missed)) == (100, 100, TOLD)


def test_the_end_tells_the_first_missed_and_how_many_more(flat):
    patrol = Patrol(PatrolParameters(places=("a", "b"), rounds=6), lambda name: Leg("lost" * (name == "b")))
    decisions = [patrol.decide(flat.world.observe()) for _ in range(12)]
    assert [d.outcome for d in decisions] == [""] * 11 + ["failed"]
    assert decisions[-1].failure == "lost"
    assert decisions[-1].why.startswith("6 of 12 visits made, missed: b (lost), b (lost)")
    many = Patrol(PatrolParameters(places=("b",), rounds=TOLD + 3), lambda _: Leg("lost"))
    for _ in range(TOLD + 3):
        last = many.decide(flat.world.observe())
    assert last.why.endswith("b (lost) and 3 more")
