"""An inspection looks once at each place it stays at, counts what changed, and goes on after a restart."""

import json
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from services.planner.mission_kinds import MissionContext, MissionError, mission_kinds
from services.planner.missions import inspect as module
from services.planner.missions.inspect import Inspect, InspectParameters
from services.planner.ports import Decision, Progress
from services.planner.profiles import DEFAULT
from shared.messages.inspections import Inspection, Region
from shared.queries import AbsentError
from tests.plane_world import PlaneMap, PlaneMatcher, PlaneWorld

CHANGE = Region(bearing_rad=0.5, elevation_rad=0.0, width_rad=0.3, height_rad=0.4)


class Leg:
    """A way that ends at once, at a place or short of it."""

    progress = Progress()

    def __init__(self, name):
        self._lost = name == "lost"

    def decide(self, _observation):
        if self._lost:
            return Decision("hold", why="lost", outcome="failed", failure="lost")
        return Decision("hold", why="there", outcome="succeeded")


@dataclass
class Eyes:
    """Sees one change from the second round on; may be away."""

    away: bool = False
    asked: list[tuple[str, int, int]] = field(default_factory=list)

    def inspect(self, place, round_number, keep):
        if self.away:
            raise AbsentError("nobody answers")
        self.asked.append((place, round_number, keep))
        seen = {"against_ns": 1, "regions": (CHANGE,)} if round_number > 1 else {"why": "no earlier picture"}
        about = {"robot": "r1", "mission_id": "m", "round": round_number, "place": place}
        return Inspection(**about, **seen)


@pytest.fixture
def world():
    return PlaneWorld((2.6, 1.3, 0.0), np.random.default_rng(3))


@pytest.fixture
def inspection(world, monkeypatch):
    monkeypatch.setattr(module, "goto_place", lambda _context, name: Leg(name))

    def make(eyes, checkpoint=None, **parameters):
        maps = PlaneMap()
        context = MissionContext(
            DEFAULT,
            maps,
            PlaneMatcher(world, maps),
            np.random.default_rng(0),
            inspector=eyes,
            checkpoint=checkpoint or {},
        )
        return Inspect(InspectParameters(**{"dwell_s": 0.0, **parameters}), context, eyes)

    return make


def decided(mission, world, most=40):
    """Decisions to the end; a frame comes every nanosecond."""
    decisions = []
    while len(decisions) < most and not (decisions and decisions[-1].outcome):
        seen = world.observe()
        frame = seen.features.model_copy(update={"stamp_ns": len(decisions)})
        decisions.append(mission.decide(replace(seen, features=frame)))
    return decisions


def test_each_place_is_looked_at_once_a_round_and_changes_are_counted(inspection, world):
    eyes = Eyes()
    mission = inspection(eyes, places=("a", "b"), rounds=2, keep=4)
    decisions = decided(mission, world)
    assert decisions[-1].outcome == "succeeded"
    assert eyes.asked == [("a", 1, 4), ("b", 1, 4), ("a", 2, 4), ("b", 2, 4)]
    told = [note for one in decisions for note in one.notes if note.kind == "inspected"]
    assert [note.values["changes"] for note in told] == [0, 0, 1, 1]
    assert told[0].reason == "a: not compared: no earlier picture"
    figures = mission.progress.figures
    assert (figures["visited"], figures["compared"], figures["changes"]) == (4, 2, 2)


def test_a_place_that_is_missed_is_not_looked_at(inspection, world):
    eyes = Eyes()
    decisions = decided(inspection(eyes, places=("a", "lost")), world)
    assert (decisions[-1].outcome, decisions[-1].failure) == ("failed", "lost")
    assert [place for place, _, _ in eyes.asked] == ["a"]


def test_the_picture_is_taken_at_the_end_of_the_stay(inspection, world):
    eyes = Eyes()
    mission = inspection(eyes, places=("a",), dwell_s=3e-9)
    waited = [decision.why for decision in decided(mission, world)]
    assert waited == ["there", "staying at a", "staying at a", "all 1 visits made"]
    assert len(eyes.asked) == 1


def test_a_look_that_fails_is_tried_again_with_the_next_frame(inspection, world):
    eyes = Eyes(away=True)
    mission = inspection(eyes, places=("a",))
    mission.decide(world.observe())
    for _ in range(3):
        with pytest.raises(AbsentError):
            mission.decide(world.observe())
    assert mission.progress.figures["visited"] == 0
    eyes.away = False
    assert mission.decide(world.observe()).outcome == "succeeded"


def test_a_planner_that_takes_over_goes_on_counting(inspection, world):
    eyes = Eyes()
    first = inspection(eyes, places=("a", "b"), rounds=2)
    while len(eyes.asked) < 3:
        first.decide(world.observe())
    kept = json.loads(json.dumps(first.progress.checkpoint))
    second = inspection(eyes, checkpoint=kept, places=("a", "b"), rounds=2)
    decided(second, world)
    assert eyes.asked[3:] == [("b", 2, 10)]
    assert second.progress.figures["changes"] == 2


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ({"places": ["Door", "door"]}, "name each once"),
        ({"places": ["Door"], "keep": 1}, "keep: Input should be greater than or equal to 2"),
    ],
)
def test_what_cannot_be_inspected_is_refused(world, parameters, words):
    maps = PlaneMap()
    context = MissionContext(
        DEFAULT, maps, PlaneMatcher(world, maps), np.random.default_rng(0), inspector=Eyes()
    )
    with pytest.raises(MissionError, match=words):
        mission_kinds()["inspect"].start(context, parameters)


def test_a_planner_without_eyes_refuses(world):
    maps = PlaneMap()
    context = MissionContext(DEFAULT, maps, PlaneMatcher(world, maps), np.random.default_rng(0))
    with pytest.raises(MissionError, match="nobody"):
        mission_kinds()["inspect"].start(context, {"places": ["door"]})
