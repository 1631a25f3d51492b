"""What a robot takes up, who is in whose way, and where one can go meanwhile."""

import pytest

from services.fleet.traffic.nearness import Nearness
from services.fleet.traffic.parties import Party, can_end, clear_share, in_the_way
from services.fleet.traffic.refuge import way_to_refuge
from shared.mapgraph.graph import MapGraph
from shared.messages.maps import Edge, Node
from tests.unit.services.fleet.traffic.corridors import corridor


def triangle(to_a_m: float, to_b_m: float, long_m: float, **edge: object) -> Nearness:
    """A leg from node 0 to node 1, and node 2 beside it."""
    lengths = {(0, 1): long_m, (0, 2): to_a_m, (1, 2): to_b_m}
    edges = [Edge(a=a, b=b, length_m=length_m, traversals=1) for (a, b), length_m in lengths.items()]
    edges[1] = edges[1].model_copy(update=edge)
    return Nearness(MapGraph([Node(node_id=node) for node in range(3)], edges))


@pytest.mark.parametrize(
    ("to_a_m", "to_b_m", "long_m", "near"),
    [
        (1.0, 5.0, 4.0, True),  # at its beginning
        (2.5, 2.5, 4.0, False),  # 1.5 m beside its middle
        (2.2, 2.2, 4.0, True),  # 0.9 m beside its middle, though its ends are further than that
        (1.3, 5.3, 4.0, False),  # behind its beginning
    ],
)
def test_a_leg_takes_up_what_lies_beside_it(to_a_m, to_b_m, long_m, near):
    assert (2 in triangle(to_a_m, to_b_m, long_m).zone((0, 1))) is near


def test_a_wall_between_two_nodes_makes_the_way_long_and_keeps_them_apart():
    assert 2 not in triangle(0.5, 9.0, 4.0, suspended=True).zone((0, 1))


def test_a_robot_that_stands_takes_up_its_node_and_those_near():
    assert corridor(9).body((4,)).zone == {3, 4, 5}


def test_a_way_is_clear_up_to_whoever_stands_on_it():
    near = corridor(9)
    assert clear_share(near, (0,), (1, 2, 3, 4, 5), near.body((5,))) == 3
    assert clear_share(near, (0,), (1, 2, 3), near.body((8,))) == 3


def test_who_is_too_near_may_go_away_and_not_nearer():
    near = corridor(9)
    assert clear_share(near, (4,), (3, 2, 1), near.body((5,))) == 3
    assert clear_share(near, (4,), (5, 6, 7), near.body((5,))) == 0


def test_two_head_on_cannot_both_end_and_one_behind_the_other_can():
    near = corridor(12)
    first, second = Party("r1", (1,), tuple(range(2, 12))), Party("r2", (10,), tuple(range(9, -1, -1)))
    assert can_end(near, {"r1": first, "r2": second}) == set()
    behind = Party("r2", (4,), (5, 6, 7, 8, 9, 10))
    assert can_end(near, {"r1": first, "r2": behind}) == {"r1", "r2"}


def test_one_that_stays_is_in_the_way_for_good_and_one_on_a_mission_is_not():
    near, first = corridor(9), Party("r1", (1,), (2, 3, 4, 5, 6))
    stands = Party("r2", (5,))
    assert can_end(near, {"r1": first, "r2": stands}) == {"r1", "r2"}
    stays = Party("r2", (5,), stays=True)
    assert can_end(near, {"r1": first, "r2": stays}) == set()
    assert in_the_way(near, first, [first, stays]) == [stays]


def test_a_refuge_is_the_nearest_node_from_which_the_other_is_let_by():
    near = corridor(12, {6: (20, 21, 22)})
    parties = {"r1": Party("r1", (1,), tuple(range(2, 12))), "r2": Party("r2", (9,), (8, 7, 6, 5, 4, 3))}
    assert way_to_refuge(near, "r2", parties, ["r1"], ()) == (9, 8, 7, 6, 20, 21)
    assert way_to_refuge(near, "r2", parties, ["r1"], {21}) == (9, 8, 7, 6, 20, 21, 22)


def test_there_is_no_refuge_beyond_another_robot():
    near = corridor(12, {6: (20, 21, 22)})
    parties = {"r1": Party("r1", (7,), (8, 9, 10, 11)), "r2": Party("r2", (9,), (8, 7, 6))}
    assert way_to_refuge(near, "r2", parties, ["r1"], ()) == ()
