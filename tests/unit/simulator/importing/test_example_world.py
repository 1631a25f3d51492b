"""The example Gazebo world, imported and rearranged: its walls are one mesh, whose hull fills both rooms."""

import numpy as np
import pytest

from simulator.generation.rearranged_world import rearrange_file
from simulator.importing.import_world import import_world
from simulator.world.freespace import free_space
from simulator.world.world_check import examine
from tests.unit.simulator.importing.conftest import EXAMPLE, named


@pytest.fixture(scope="module")
def imported(tmp_path_factory):
    told = []
    into = tmp_path_factory.mktemp("imported") / "house"
    result = import_world(EXAMPLE, into, progress=lambda *step: told.append(step))
    return result, told


def test_nothing_is_missing_and_progress_is_told(imported):
    result, told = imported
    assert result.notes == ()
    assert result.path.name == "house.yaml"
    assert {stage for stage, _, _ in told} == {"models", "free floor"}


def test_both_rooms_are_free_and_joined_by_the_doorway(imported):
    space = free_space(imported[0].world)
    assert space.is_free((1.0, 1.2))
    assert space.is_free((5.0, 1.0))
    assert not space.is_free((4.05, 3.3))
    assert space.shortest_path_m((1.0, 1.2), (5.0, 1.0)) == pytest.approx(4.4, abs=0.3)


def test_check_finds_neither_faults_nor_floor_that_is_cut_off(imported):
    report = examine(imported[0].world)
    assert report.faults == report.doubts == ()
    assert report.floor_m2 == pytest.approx(8.3 * 4.2, abs=0.5)
    assert report.free_m2 == pytest.approx(18.1, abs=0.5)
    assert report.cut_off_m2 == 0.0
    assert report.lights == 2


def test_start_is_free_on_all_sides(imported):
    start = imported[0].world.start
    space = free_space(imported[0].world)
    assert space.clearance_m[space.cell((start.x_m, start.y_m))] >= 0.55


def test_picture_named_by_a_path_upwards_is_shown(imported):
    table = named(imported[0].world, "table").options["file"]
    pictures = [patch.picture.pixels for patch in table.patches]
    assert max(pixels.shape[0] for pixels in pictures) == 256


def test_collision_shape_of_its_own_is_what_is_felt(imported):
    table = named(imported[0].world, "table")
    assert len(table.options["file"].patches[0].mesh.triangles) == 60
    assert len(table.options["collision"]["file"].patches[0].mesh.triangles) == 12


def test_glass_stops_the_robot_and_shows_nothing(imported):
    pane = named(imported[0].world, "walls pane")
    assert not any(patch.seen for patch in pane.options["file"].patches)
    assert pane.options["collision"]["file"].patches


def test_equal_models_share_a_file_and_tilted_ones_keep_their_tilt(imported):
    world = imported[0].world
    chairs = [named(world, f"chair-{k}").options["file"].name for k in (1, 2, 3)]
    assert chairs == ["chair.glb"] * 3
    assert named(world, "beam").options["pitch_deg"] == pytest.approx(np.degrees(0.35), abs=0.01)


def test_a_third_of_the_furniture_can_be_rearranged_within_its_room(imported):
    result, _ = imported
    later = rearrange_file(str(result.path), result.path.with_name("later.yaml"), seed=3, share=1.0)
    before = {item.name: item.at_m for item in result.world.furniture if item.name}
    after = {item.name: item.at_m for item in later.furniture if item.name}
    assert before["walls walls"] == after["walls walls"]
    moved = [name for name in after if after[name] != before[name]]
    gone = set(before) - set(after)
    assert moved or gone
    for name in moved:
        assert (before[name][0] < 4.05) == (after[name][0] < 4.05), "furniture went through a wall"
    assert examine(later).faults == ()
