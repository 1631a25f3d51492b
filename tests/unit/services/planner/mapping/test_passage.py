"""With a person at the wheel: a node is made before the last one is out of sight, whatever else is seen."""

from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.mapping.passage import Passage
from services.planner.ports import Observation
from services.planner.profiles import DEFAULT
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import Node
from tests.unit.services.planner.mapping.test_departure import RANGES, STEP, Matcher
from tests.unit.services.planner.travel.seen import Maps, features, match

FAINT, PLAIN = DEFAULT.mapping.s_sure - 5, DEFAULT.mapping.s_node_max + 60


def test_where_the_last_node_fades_a_node_is_made_though_one_that_is_not_joined_is_very_like_it():
    matcher = Matcher()
    maps = Maps(MapGraph([Node(node_id=node, open=(True,) * 12) for node in (0, 7)]))
    passage = Passage(DEFAULT, maps, matcher, Displacement(0), FloorViews(0.27))
    matcher.also = match(7, 0.3, 0.0, PLAIN)
    for step in range(1, 10):
        matcher.seen = match(0, -0.12 * step, 0.0, PLAIN)
        assert passage.step(Observation(features(), RANGES, STEP)) is None
    matcher.seen = match(0, -1.2, 0.0, FAINT)
    reached = passage.step(Observation(features(), RANGES, STEP))
    assert reached is not None
    assert reached.new
    assert maps.graph.edge(0, reached.node_id).traversals == 1
