"""Keys: names are checked, no two streams share one."""

import pytest

from shared.topics import COMMAND, FRAME, MAP, QUERIES, TOPICS
from shared.transport.keys import alive_key


def test_a_key_is_its_template_with_the_names_in_place():
    assert FRAME.key(robot="r1") == "topnav/r1/frame"
    assert MAP.key(map="*") == "topnav/maps/*/graph"
    assert alive_key("map_store", "*") == "topnav/alive/map_store/*"


@pytest.mark.parametrize(
    "name", ["", "R1", "a/b", "..", "**", "r1\n", "r 1", "\u00e4", "x" * 65, "$*", "a\0"]
)
def test_names_outside_the_rule_are_refused(name: str):
    with pytest.raises(ValueError, match=r"robot must match \[a-z0-9_-\]"):
        COMMAND.key(robot=name)


def test_every_stream_has_a_key_of_its_own():
    templates = [stream.template for stream in (*TOPICS, *QUERIES)]
    assert len(set(templates)) == len(templates)
