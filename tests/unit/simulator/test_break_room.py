"""The break room: one connected floor, large enough to hide on."""

import math

from simulator.world.freespace import free_space
from simulator.world.world_file import load_world


def test_the_break_room_and_its_corridor_are_one_floor():
    space = free_space(load_world("break_room"))
    assert len(space.centres_m()) * space.resolution_m**2 > 35.0
    for corner in ((1.3, 2.4), (7.6, 2.6), (8.3, -1.1), (0.2, -1.1), (4.0, 5.3)):
        assert space.is_free(corner), corner
        assert math.isfinite(space.shortest_path_m((4.5, 1.1), corner))
