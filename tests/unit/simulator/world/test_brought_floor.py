"""Floor that models bring: where it is, where it ends, and what the world check says of such a world."""

import numpy as np
import pytest
import trimesh
import yaml

from simulator.world.contents import expand
from simulator.world.floating import floating
from simulator.world.footprints import cast_rays, footprints
from simulator.world.freespace import BODY_BAND_M, free_space
from simulator.world.world_check import examine
from simulator.world.world_file import load_world


def slab(x, y, z):
    """A box by its extents."""
    box = trimesh.creation.box((x[1] - x[0], y[1] - y[0], z[1] - z[0]))
    box.apply_translation(((x[0] + x[1]) / 2, (y[0] + y[1]) / 2, (z[0] + z[1]) / 2))
    return box


@pytest.fixture
def world_of(tmp_path):
    """A world of slabs by name, on a ground of 10 x 10 m that has no floor of its own."""

    def make(start=(1.0, 1.0), **slabs):
        items = []
        for name, (extents, more) in slabs.items():
            trimesh.Scene([slab(*extents)]).export(tmp_path / f"{name}.glb")
            options = {"file": f"{name}.glb", "up": "z", "centred": False}
            items.append({"kind": "mesh", "name": name, "at_m": [0, 0], "options": options} | more)
        data = {
            "format": "topnav-world/1",
            "name": "brought",
            "start": {"x_m": start[0], "y_m": start[1]},
            "grounds": [{"name": "floor", "x_m": [0, 10], "y_m": [0, 10]}],
            "furniture": items,
        }
        (tmp_path / "w.yaml").write_text(yaml.safe_dump(data), encoding="utf-8")
        return load_world(str(tmp_path / "w.yaml"))

    return make


def floor(x=(0, 4), y=(0, 4), z=(-0.1, 0.0)):
    return (x, y, z), {}


def test_floor_is_where_something_lies_level_at_height_nought(world_of):
    space = free_space(
        world_of(a=floor(), roof=floor(x=(5, 9), z=(2.4, 2.5)), ramp=floor((6, 9), z=(0.3, 0.4)))
    )
    assert space.is_free((2.0, 2.0))
    assert not space.is_free((7.0, 2.0))
    assert not space.is_free((2.0, 6.0))
    assert space.free.sum() * 0.05**2 == pytest.approx(3.4**2, rel=0.05)


def test_gap_of_a_sill_is_driven_over_and_a_wide_one_is_not(world_of):
    sill = free_space(world_of(a=floor(), b=floor(x=(4.25, 8))))
    assert sill.shortest_path_m((1.0, 1.0), (7.0, 1.0)) == pytest.approx(6.0, abs=0.1)
    trench = free_space(world_of(a=floor(), b=floor(x=(4.8, 8))))
    assert not trench.is_free((7.0, 1.0))


def test_the_end_of_the_floor_is_felt_by_the_sensors(world_of):
    parts, _ = expand(world_of(a=floor()))
    shapes = footprints(parts, *BODY_BAND_M)
    distances = cast_rays(np.array([1.0, 2.0]), np.array([0.0, np.pi]), shapes, 4.0)
    assert distances == pytest.approx([3.0, 1.0], abs=0.06)


def test_thin_rug_takes_no_floor_away(world_of):
    with_rug = free_space(world_of(a=floor(), rug=floor((1, 3), (1, 3), (0.0, 0.015))))
    assert with_rug.free.sum() == free_space(world_of(a=floor())).free.sum()


def test_report_has_the_area_of_the_floor_and_leaves_out_what_lies_outside(world_of):
    report = examine(world_of(a=floor()))
    assert report.floor_m2 == pytest.approx(16.0, abs=0.8)
    assert (report.cut_off_m2, report.unreachable, report.faults) == (0.0, (), ())


def test_what_hangs_in_the_air_is_named_and_what_stands_hangs_or_lies_on_something_is_not(world_of):
    wall, table = ((0, 4), (3.9, 4.0), (0, 2.5)), ((1, 2), (2, 3), (0, 0.7))
    world = world_of(
        start=(3.0, 1.0),
        a=floor(),
        wall=(wall, {}),
        table=(table, {}),
        ball=(((3, 3.3), (2, 2.3), (0.3, 0.6)), {}),
        vase=(((1.4, 1.6), (2.4, 2.6), (0.72, 0.95)), {}),
        picture=(((1, 1.5), (3.85, 3.88), (1.2, 1.6)), {}),
        lamp=(((2, 2.4), (1, 1.4), (2.2, 2.4)), {}),
    )
    assert floating(world) == ["ball (0.30 m up)"]
    assert any("nothing holds ball (0.30 m up)" in doubt for doubt in examine(world).doubts)
