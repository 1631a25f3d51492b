"""Keys: names are checked, no two streams share one."""

import pytest

from shared.topics import FRAME, MAP, MISSION_RECORD, QUERIES, TOPICS, VELOCITY
from shared.transport.keys import RESERVED, alive_key, robot_key


def test_a_key_is_its_template_with_the_names_in_place():
    assert FRAME.key(robot="r1") == "topnav/r1/frame"
    assert MAP.key(map="*") == "topnav/maps/*/graph"
    assert alive_key("map_store", "*") == "topnav/alive/map_store/*"


@pytest.mark.parametrize(
    "name", ["", "R1", "a/b", "..", "**", "r1\n", "r 1", "\u00e4", "x" * 65, "$*", "a\0"]
)
def test_names_outside_the_rule_are_refused(name: str):
    with pytest.raises(ValueError, match=r"a robot's name must match \[a-z0-9_-\]"):
        VELOCITY.key(robot=name)
    with pytest.raises(ValueError, match=r"map must match \[a-z0-9_-\]"):
        MAP.key(map=name)


@pytest.mark.parametrize("name", RESERVED)
def test_no_robot_has_a_name_that_begins_other_keys(name: str):
    for key in (VELOCITY.key, MISSION_RECORD.key, lambda robot: robot_key(robot, "*")):
        with pytest.raises(ValueError, match=f"begin keys of no robot; got '{name}'"):
            key(robot=name)
    assert MAP.key(map=name) == f"topnav/maps/{name}/graph"


def test_the_names_that_no_robot_has_are_those_that_begin_other_keys():
    templates = [stream.template for stream in (*TOPICS, *QUERIES)]
    begin = {key.split("/")[1] for key in (*templates, alive_key("*", "*"), robot_key("*", "*"))}
    assert begin == {"{robot}", *RESERVED}


def test_every_stream_has_a_key_of_its_own():
    templates = [stream.template for stream in (*TOPICS, *QUERIES)]
    assert len(set(templates)) == len(templates)
