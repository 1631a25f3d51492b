"""A sign leads to the node that it is read from best, of those that no rule forbids."""

import pytest

from services.planner.goals.nodes import node_reading
from services.planner.mission_kinds import MissionError
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Node
from shared.messages.places import KeepOut, PutRule, Sighting, Sign
from tests.plane_world import PlaneMap


@pytest.fixture
def maps() -> PlaneMap:
    """Three nodes, and a sign that is read from two of them."""
    seen = tuple(Sighting(node=n, bearing_rad=0.0, height_rad=0.1, confidence=1.0) for n in (2, 1))
    signs = (Sign(name="214", sightings=seen), Sign(name="218"))
    return PlaneMap(MapGraph([Node(node_id=n) for n in range(3)], signs=signs))


def test_the_best_node_is_taken_and_the_next_one_where_a_rule_forbids_it(maps: PlaneMap):
    assert node_reading(maps, "room 214") == 2
    maps.commit([PutRule(rule=KeepOut(name="wet floor", nodes=(2,)))])
    assert node_reading(maps, "214") == 1
    maps.commit([PutRule(rule=KeepOut(name="closed", nodes=(1,)))])
    with pytest.raises(MissionError, match="sign '214' is forbidden by rule 'wet floor'") as refused:
        node_reading(maps, "214")
    assert refused.value.code == "forbidden"


@pytest.mark.parametrize(("text", "words"), [("215", "nearest: '218', '214'"), ("218", "no node any more")])
def test_a_sign_that_is_not_there_is_a_typed_refusal(maps: PlaneMap, text: str, words: str):
    with pytest.raises(MissionError, match=words) as refused:
        node_reading(maps, text)
    assert refused.value.code == "missing"
