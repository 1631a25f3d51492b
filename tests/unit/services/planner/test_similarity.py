"""What a match says of where its node is."""

import pytest

from services.planner.profiles import DEFAULT
from services.planner.similarity import tells_place
from tests.unit.services.planner.travel.seen import match
from tests.unit.shared.mapgraph.local.places import ROOM, STREET


@pytest.mark.parametrize(
    ("graph", "inliers", "told"), [(ROOM, 27, True), (STREET, 27, False), (STREET, 250, True)]
)
def test_bearings_that_do_not_change_are_of_this_spot_or_of_what_is_far_away(graph, inliers, told):
    """In a street 27 matches agreed 20 m from the node; at the very spot 300 do."""
    here = match(1, 0.0, 0.0, inliers)
    assert here.status == "no_baseline"
    assert tells_place(here, graph, DEFAULT) == told


@pytest.mark.parametrize("graph", [ROOM, STREET])
def test_a_node_in_a_known_direction_is_told_by_few(graph):
    ahead = match(1, 3.0, 0.0, 27)
    assert tells_place(ahead, graph, DEFAULT)
    assert not tells_place(ahead.model_copy(update={"heading_std_rad": 0.3}), graph, DEFAULT)
