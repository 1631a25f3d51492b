"""What the record of a mission says about it."""

import pytest

from services.planner.control.records import has_goal
from shared.messages.maps import MissionRecord
from tests.plane_world import picture


def record(**values):
    return MissionRecord(robot="r1", action="goto", map="flat", **values)


@pytest.mark.parametrize(
    "values",
    [
        {"goal": picture((0.0, 0.0, 0.0))},
        {"goal_node": 3},
        {"parameters": {"goal_node": 3}},
        {"parameters": {"place": "kitchen"}},
        {"parameters": {"sign": "214"}},
    ],
)
def test_a_mission_to_somewhere_on_the_map_has_a_goal(values):
    assert has_goal(record(**values))


def test_a_mission_to_nowhere_in_particular_has_none():
    assert not has_goal(record(parameters={"back": True}))
