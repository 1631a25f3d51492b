"""Panels cover a span without gaps, meet where textures meet, and differ."""

from itertools import pairwise

import pytest

from simulator.world.rooms import cut, room_parts, variant
from simulator.world.world_file import load_world


@pytest.mark.parametrize("span", [(0.0, 18.0), (-1.3, 7.9), (5.0, 5.5), (0.2, 3.1), (-20.0, -3.3)])
def test_pieces_cover_the_span_and_meet_at_multiples_of_the_tile(span):
    pieces = cut(span, 3.0)
    assert (pieces[0][0], pieces[-1][1]) == span
    for first, second in pairwise(pieces):
        assert first[1] == second[0]
        assert first[1] % 3.0 == pytest.approx(0.0)
    assert all(high - low > 1.5 for low, high in pieces) or len(pieces) == 1


def test_variants_are_irregular_and_stay_the_same():
    shown = [variant(5, 0, 0.0, 3.0 * k) for k in range(60)]
    assert shown == [variant(5, 0, 0.0, 3.0 * k) for k in range(60)]
    assert set(shown) == set(range(5))
    assert len({tuple(shown[k : k + 4]) for k in range(56)}) > 40
    assert variant(1, 2.0) == 0


def test_walls_of_variants_cover_what_a_plain_wall_covers():
    plain = load_world("factory")
    hall = plain.rooms[0]
    same = hall.model_copy(update={"walls": hall.walls.model_copy(update={"variants": 1})})
    area = [
        sum(p.size_m[0] * p.size_m[1] * p.size_m[2] for p in room_parts(world) if p.solid)
        for world in (plain, plain.model_copy(update={"rooms": (same,)}))
    ]
    assert area[0] == pytest.approx(area[1], rel=1e-6)
