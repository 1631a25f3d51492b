"""Which node the thesis's rules set out from, and where they go on when no way leads from there."""

from services.planner.profiles import DEFAULT, THESIS
from services.planner.travel.localisation import edge_cost, starts_in_sight
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.routing import plan_path
from shared.messages.maps import Edge, Node
from shared.messages.sensors import Ranges
from tests.unit.services.planner.travel.seen import by_node, match

RANGES = Ranges(robot="r1", angles_rad=(0.0,) * 12, distances_m=(5.0,) * 12, max_range_m=5.0)
SEEN = by_node(match(0, 2.0, 0.0, 60), match(1, 0.5, 0.0, 100), match(2, 3.0, 0.0, 20), match(3, 9.0, 0.0, 5))
"""With 20 raw matches more each, of which these rules want more than 30."""


def chain(*ends):
    edges = [Edge(a=min(e), b=max(e), raw_matches=80, inliers=80, clear=True) for e in ends]
    return MapGraph([Node(node_id=n) for n in range(6)], edges)


def path(flat, profile, banned=()):
    starts = starts_in_sight(SEEN, flat, RANGES, profile)
    return plan_path(flat, starts, {5: 0.0}, edge_cost(flat, profile), banned=banned)


def test_the_thesis_sets_out_from_the_most_similar_node_however_much_longer_that_is():
    flat = chain((0, 5), (1, 4), (4, 5))
    assert path(flat, THESIS) == [1, 4, 5]
    assert path(flat, DEFAULT) == [0, 5]


def test_where_no_way_leads_on_from_that_it_sets_out_from_the_next():
    flat = chain((0, 5), (1, 4), (2, 5), (4, 5))
    assert path(flat, THESIS, banned={(1, 4)}) == [0, 5]
    assert path(flat, THESIS, banned={(1, 4), (0, 5)}) == [2, 5]


def test_it_sets_out_from_no_node_that_is_not_similar_enough():
    assert 3 not in starts_in_sight(SEEN, chain((3, 5)), RANGES, THESIS)


def test_an_edge_too_weak_for_the_rules_of_the_driver_is_its_last_resort():
    weak = Edge(a=1, b=5, raw_matches=THESIS.mapping.s_edge_min, inliers=30, clear=True)
    flat = chain((1, 4), (4, 5))
    flat.edges[1, 5] = weak
    assert path(flat, THESIS) == [1, 4, 5]
    assert path(MapGraph(flat.nodes.values(), [weak]), THESIS) == [1, 5]
