"""Open ground: floors, and borders that nobody crosses."""

from itertools import pairwise

import numpy as np
import pytest

from simulator.scene.parts import solids_between
from simulator.world.freespace import free_space
from simulator.world.grounds import BORDERS, ground_parts
from simulator.world.world_file import WorldFile, WorldFileError, load_world

GRASS = {"texture": "grass", "colour": [98, 126, 66]}


def world(grounds, **more):
    data = {"format": "topnav-world/1", "name": "yard", "start": {"x_m": 2.0, "y_m": 2.0}, "grounds": grounds}
    return WorldFile.model_validate({**data, **more})


def ground(x_m, y_m, border="none", name="yard"):
    return {"name": name, "x_m": x_m, "y_m": y_m, "floor": GRASS, "border": border}


@pytest.mark.parametrize("border", sorted(BORDERS))
def test_borders_stop_the_robot_on_all_four_sides(border):
    yard = world([ground([0, 6], [0, 5], border)])
    solids = solids_between(ground_parts(yard), 0.02, 0.13)
    for x, y in ((-0.05, 2.5), (6.05, 2.5), (3.0, -0.05), (3.0, 5.05)):
        assert any(
            abs(p.centre_m[0] - x) <= p.size_m[0] / 2 and abs(p.centre_m[1] - y) <= p.size_m[1] / 2
            for p in solids
        ), (x, y)


@pytest.mark.parametrize(("border", "texture"), [("wall", "bricks"), ("sidewalk", "paving")])
def test_no_texture_follows_on_itself_along_a_border(border, texture):
    """Beside bricks that repeated every 1.6 m a robot took spots so far apart for one."""
    parts = ground_parts(world([ground([0, 40], [0, 30], border)]))
    south = [p for p in parts if p.material.kind == texture and p.centre_m[1] < 0.0 and p.size_m[0] < 30.0]
    south.sort(key=lambda p: p.centre_m[0])
    assert len(south) > 20
    assert all(p.tile_m and p.size_m[0] < 1.5 * p.tile_m for p in south)
    assert all(a.material.seed != b.material.seed for a, b in pairwise(south))
    assert len({p.material.seed for p in south}) > 6


def test_nothing_stands_where_two_grounds_touch():
    pair = world([ground([0, 4], [0, 4], "fence", "west"), ground([4, 8], [0, 4], "fence", "east")])
    space = free_space(pair)
    assert space.is_free((3.9, 2.0))
    assert space.is_free((4.1, 2.0))
    assert space.shortest_path_m((1.0, 2.0), (7.0, 2.0)) == pytest.approx(6.0, abs=0.1)


def test_free_floor_ends_at_the_border():
    space = free_space(world([ground([0, 6], [0, 5], "barrier")]))
    centres = space.centres_m()
    assert centres.min() > 0.2
    assert centres[:, 0].max() < 5.8
    assert len(centres) * space.resolution_m**2 == pytest.approx(5.5 * 4.5, rel=0.05)


def test_a_world_without_any_floor_is_refused():
    with pytest.raises(ValueError, match="at least one room or one ground"):
        world([])


def test_a_gate_joins_hall_and_yard():
    paint = {"texture": "concrete", "colour": [170, 170, 166]}
    hall = {"name": "hall", "x_m": [0, 5], "y_m": [0, 4], "floor": paint, "walls": paint, "ceiling": paint}
    gate = {"x_m": [5, 5.15], "y_m": [1, 3], "floor": paint}
    yard = ground([5.15, 10], [0, 4], "wall")
    space = free_space(world([yard], rooms=[hall], openings=[gate]))
    assert space.shortest_path_m((2.0, 2.0), (8.0, 2.0)) == pytest.approx(6.0, abs=0.1)
    assert not np.isfinite(space.shortest_path_m((2.0, 2.0), (30.0, 2.0))) or not space.is_free((30.0, 2.0))


def test_the_village_is_large_connected_and_closed():
    village = load_world("village")
    xs, ys = zip(*[(g.x_m, g.y_m) for g in village.grounds], strict=True)
    assert max(x[1] for x in xs) - min(x[0] for x in xs) >= 60.0
    assert max(y[1] for y in ys) - min(y[0] for y in ys) >= 60.0
    space = free_space(village)
    free_m2 = len(space.centres_m()) * space.resolution_m**2
    assert free_m2 > 2000.0
    assert village.environment == "outdoor"
    assert {g.border for g in village.grounds} >= {"fence", "barrier", "sidewalk"}
    for corner in ((1.5, 1.5), (62.5, 1.5), (1.5, 62.5), (62.5, 62.5)):
        assert space.shortest_path_m((32.0, 24.0), corner) < 90.0


def test_unknown_borders_are_named(tmp_path):
    path = tmp_path / "w.yaml"
    path.write_text(
        "format: topnav-world/1\nname: w\nstart: {x_m: 1, y_m: 1}\n"
        "grounds: [{name: g, x_m: [0, 4], y_m: [0, 4], border: moat, "
        "floor: {texture: grass, colour: [1, 2, 3]}}]\n"
    )
    with pytest.raises(WorldFileError, match=r"grounds.0.border.*'fence'"):
        load_world(str(path))
