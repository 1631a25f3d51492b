"""Kinds of missions are found in their folder and in a file of one's own; what does not fit is refused."""

import numpy as np
import pytest

from services.planner.mission_kinds import MissionContext, MissionError, mission_kinds
from services.planner.missions.explore import FrontierExploration
from services.planner.missions.goto import Goto
from services.planner.profiles import DEFAULT
from shared.messages.maps import Node
from tests.plane_world import PlaneMap, picture

WAVE = """
from pydantic import BaseModel

from services.planner.mission_kinds import MissionKind
from services.planner.ports import Decision, Progress


class Times(BaseModel):
    times: int = 1


class Wave:
    def __init__(self, times):
        self.times, self.done = times, 0

    @property
    def progress(self):
        return Progress(figures={"waved": self.done})

    def decide(self, observation):
        self.done += 1
        return Decision("hold", why="waving", outcome="succeeded" if self.done == self.times else "")


KIND = MissionKind("wave", "Wave", Times, lambda context, wanted: Wave(wanted.times), shown=("waved",))
"""


@pytest.fixture
def context():
    maps = PlaneMap()
    maps.graph.nodes[0] = Node(node_id=0)
    return MissionContext(DEFAULT, maps, None, np.random.default_rng(0))


def with_goal(context):
    return MissionContext(context.profile, context.maps, None, context.rng, picture((0, 0, 0)))


def test_the_kinds_of_the_planner_are_found_in_their_folder():
    infos = {info.name: info for info in mission_kinds().infos()}
    assert {"explore", "goto"} <= infos.keys()
    assert infos["goto"].takes_picture
    assert "goal_node" in infos["goto"].parameters["properties"]
    assert not infos["explore"].takes_picture


def test_they_start_with_their_parameters(context):
    kinds = mission_kinds()
    assert isinstance(kinds["explore"].start(context, {}), FrontierExploration)
    assert isinstance(kinds["goto"].start(with_goal(context), {}), Goto)


def test_a_file_of_ones_own_is_one_more_kind(tmp_path, context):
    (tmp_path / "wave.py").write_text(WAVE)
    kinds = mission_kinds(tmp_path)
    mission = kinds["wave"].start(context, {"times": 2})
    assert [mission.decide(None).outcome for _ in range(2)] == ["", "succeeded"]
    assert next(info for info in kinds.infos() if info.name == "wave").shown == ("waved",)


@pytest.mark.parametrize(
    ("name", "values", "words"),
    [
        ("dance", {}, r"unknown mission 'dance', this planner knows explore, goto"),
        ("explore", {"speed": 3}, "parameters of explore: speed"),
        ("goto", {"goal_node": "kitchen"}, "parameters of goto: goal_node"),
        ("goto", {}, "exactly one of them"),
        ("goto", {"goal_node": 7}, "no node 7"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(context, name, values, words):
    with pytest.raises(MissionError, match=words):
        mission_kinds()[name].start(context, values)


def test_a_picture_is_refused_where_none_is_taken(context):
    with pytest.raises(MissionError, match="explore takes no goal picture"):
        mission_kinds()["explore"].start(with_goal(context), {})


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("x = 1", r"mine\.py: a mission must define KIND"),
        ("1 / 0", r"mine\.py: ZeroDivisionError"),
        (WAVE.replace('"wave"', '"goto"'), "'goto' is taken"),
        (WAVE.replace('"wave"', '"cancel"'), "'cancel' is taken"),
    ],
)
def test_a_file_that_is_no_mission_is_named(tmp_path, content, words):
    (tmp_path / "mine.py").write_text(content)
    with pytest.raises(ValueError, match=words):
        mission_kinds(tmp_path)
