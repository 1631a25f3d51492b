"""Directions that lead to floor which nodes around cover already are not explored."""

import pytest

from services.planner.mapping.frontiers.floor_gain import best_sector, without_poor_directions
from services.planner.mapping.frontiers.floor_views import FloorViews
from services.planner.profiles import DEFAULT
from shared.mapgraph.frontiers import frontier_sectors, sector_rad
from shared.mapgraph.graph import MapGraph
from shared.mapgraph.local.displacement import Displacement
from shared.messages.maps import Node
from shared.messages.sensors import Ranges
from tests.unit.shared.mapgraph.local.grid import edge

ALL = (True,) * 12
EAST, SOUTH, WEST, NORTH = {11, 0, 1}, {8, 9, 10}, {5, 6, 7}, {2, 3, 4}
COLUMNS, ROWS = 5, 4
INSIDE, BORDER, CORNER = 7, 2, 0
RADIUS_M = 0.27


def grid(free_m=(3.0,) * 12, *, clear=True):
    """Nodes a metre apart that look along x, all open; edges over free ground join those side by side."""
    count = COLUMNS * ROWS
    nodes = [Node(node_id=n, open=ALL, free_m=free_m) for n in range(count)]
    pairs = [(n, n + 1) for n in range(count) if (n + 1) % COLUMNS]
    pairs += [(n, n + COLUMNS) for n in range(count - COLUMNS)]
    edges = [edge(a, b, COLUMNS).model_copy(update={"traversals": 0, "clear": clear}) for a, b in pairs]
    return MapGraph(nodes, edges)


def chosen(graph, node, preferred_rad, profile=DEFAULT):
    sectors = frontier_sectors(graph.nodes[node])
    return best_sector(graph, node, sectors, preferred_rad, profile, FloorViews(RADIUS_M))


def left(graph, root, views=None, **changes):
    """Directions that are still to be explored, by node."""
    views = FloorViews(RADIUS_M) if views is None else views
    poor = without_poor_directions(graph, root, DEFAULT.replaced(**changes), views)
    changed = {n.node_id: n for n in poor}
    return {n: set(frontier_sectors(changed.get(n, node))) for n, node in graph.nodes.items()}


def test_inside_the_map_nothing_is_worth_the_way_and_at_its_border_what_leads_out():
    found = left(grid(), INSIDE)
    assert found[INSIDE] == set()
    assert found[BORDER] >= SOUTH
    assert not found[BORDER] & (NORTH | {0, 6})
    assert found[CORNER] >= {7, 8}
    assert not found[CORNER] & {1, 2}


def test_the_most_that_a_direction_of_each_node_leads_to_is_kept_for_the_order_of_visits():
    views = FloorViews(RADIUS_M)
    left(grid(), INSIDE, views)
    assert views.gains[INSIDE] < DEFAULT.mapping.gain_min < min(views.gains[BORDER], views.gains[CORNER])


def test_floor_behind_a_door_is_explored_from_where_it_shows_though_a_nearer_node_sees_the_wall_beside_it():
    graph, past_the_door, walled = grid(), [3.0] * 12, [3.0] * 12
    walled[7:12] = [0.5] * 5
    past_the_door[8] = past_the_door[10] = 0.5
    nodes = [
        n.model_copy(update={"free_m": tuple(past_the_door if n.node_id == INSIDE else walled)})
        for n in graph.nodes.values()
    ]
    found = left(MapGraph(nodes, list(graph.edges.values())), INSIDE)
    assert found[INSIDE] == {9}
    assert found[BORDER] == set()


def test_a_few_decimetres_before_a_wall_lead_nowhere():
    assert left(grid(free_m=(0.4,) * 12), INSIDE)[BORDER] == set()


def test_a_node_behind_a_wall_covers_nothing_on_this_side():
    walled = left(grid(clear=False), INSIDE)
    assert walled[INSIDE] == set(range(12))


def test_a_map_from_before_free_ways_were_kept_counts_as_open():
    assert left(grid(free_m=None), INSIDE)[BORDER] >= {9}


def test_far_from_the_new_node_nothing_is_judged():
    found = left(grid(), 0, covers_m=0.9)
    assert found[COLUMNS * ROWS - 1] == set(range(12))


@pytest.mark.parametrize("changes", [{"covers_m": 0.0}, {"gain_min": 0.0}])
def test_profiles_that_ask_for_no_gain_explore_everything(changes):
    assert left(grid(), INSIDE, **changes)[INSIDE] == set(range(12))


def wall_in_the_south(away_m, range_m=4.0):
    """Views from the nodes along the southern border, every quarter of a metre."""
    views, echo_m = FloorViews(RADIUS_M), [range_m] * 12
    echo_m[7:12] = [1.41 * away_m, away_m, away_m, away_m, 1.41 * away_m]
    angles_rad = tuple(sector_rad(sector) for sector in range(12))
    seen = Ranges(robot="r1", angles_rad=angles_rad, distances_m=tuple(echo_m), max_range_m=range_m)
    for node in range(COLUMNS):
        for x_m in (0.0, 0.25, 0.5, 0.75):
            views.add(Displacement(node, x_m), seen)
    return views


def test_a_wall_seen_from_close_by_leads_nowhere_though_the_robot_would_fit_between_two_echoes():
    assert left(grid(), INSIDE)[BORDER] >= SOUTH
    assert not left(grid(), INSIDE, wall_in_the_south(0.9))[BORDER] & SOUTH
    assert left(grid(), INSIDE, wall_in_the_south(1.8))[BORDER] >= SOUTH


def test_walls_tell_only_where_the_sensors_reach_as_far_as_floor_is_looked_for():
    wide = {"covers_m": 2.0}
    assert left(grid(), INSIDE, wall_in_the_south(0.9, range_m=4.0), **wide)[BORDER] >= SOUTH
    assert not left(grid(), INSIDE, wall_in_the_south(0.9, range_m=12.0), **wide)[BORDER] & SOUTH


@pytest.mark.parametrize(("covers_m", "worth"), [(1.0, set()), (4.0, set(range(12)))])
def test_where_nodes_cover_more_a_smaller_share_of_that_is_worth_the_way(covers_m, worth):
    ways_m = (0.5 * covers_m,) * 12
    lonely = MapGraph([Node(node_id=0, open=ALL, free_m=ways_m)], [])
    assert left(lonely, 0, covers_m=covers_m, gain_min=0.25)[0] == worth


def test_an_empty_neighbourhood_is_all_new():
    lonely = MapGraph([Node(node_id=0, open=ALL, free_m=(3.0,) * 12)], [])
    assert left(lonely, 0)[0] == set(range(12))


def test_a_node_is_left_where_most_is_new_and_straight_on_where_as_much_is():
    assert chosen(grid(), BORDER, 0.0) == 9
    alone = MapGraph([Node(node_id=0, open=ALL, free_m=(3.0,) * 12)], [])
    assert [chosen(alone, 0, heading) for heading in (0.0, 1.6, -0.5)] == [0, 3, 11]


def test_where_every_direction_is_to_be_explored_the_one_ahead_comes_first():
    every = DEFAULT.replaced(covers_m=0.0)
    assert chosen(grid(), BORDER, 1.6, every) == 3


def test_a_node_with_nothing_unexplored_has_no_best_direction():
    done = MapGraph([Node(node_id=0, open=ALL, explored=ALL)], [])
    assert chosen(done, 0, 0.0) is None
