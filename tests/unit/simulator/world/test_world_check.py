"""Looking at a world before driving in it: faults, doubts, areas and narrow passages."""

import copy

import pytest

from simulator.world.world_check import examine, start_faults
from simulator.world.world_file import WorldFile


def two_rooms(room_data, gap_m=(1.5, 2.5), second_x=(6.15, 10.0)):
    """The plain room, another one east of it, and an opening between them."""
    data = copy.deepcopy(room_data)
    paint = data["rooms"][0]["floor"]
    data["rooms"].append({**data["rooms"][0], "name": "second", "x_m": list(second_x)})
    data["openings"] = [{"x_m": [6, 6.15], "y_m": list(gap_m), "floor": paint}]
    data["furniture"] = [{"kind": "ceiling_light", "at_m": [3, 2], "z_m": 2.6}]
    return data


def report_of(data):
    return examine(WorldFile.model_validate(data))


def test_sound_world_has_neither_faults_nor_doubts(room_data):
    report = report_of(two_rooms(room_data))
    assert (report.faults, report.doubts, report.unreachable) == ((), (), ())
    assert report.size_m == (10.0, 4.0)
    assert report.floor_m2 == pytest.approx(24 + 3.85 * 4 + 0.15)
    assert report.start_free
    assert 20 < report.free_m2 < report.floor_m2


@pytest.mark.parametrize("width_m", [0.7, 1.0, 1.3])
def test_width_and_place_of_a_doorway_are_found(room_data, width_m):
    report = report_of(two_rooms(room_data, (2.0 - width_m / 2, 2.0 + width_m / 2)))
    doorways = [p for p in report.passages if p.behind_m2 > 2]
    assert len(doorways) == 1
    assert doorways[0].width_m == pytest.approx(width_m, abs=0.06)
    assert (doorways[0].x_m, doorways[0].y_m) == pytest.approx((6.07, 2.0), abs=0.3)


def test_doorway_hardly_wider_than_the_robot_is_a_doubt(room_data):
    report = report_of(two_rooms(room_data, (1.7, 2.3)))
    assert any("tight" in doubt for doubt in report.doubts)


def test_room_behind_too_narrow_a_doorway_cannot_be_reached(room_data):
    report = report_of(two_rooms(room_data, (1.8, 2.2)))
    assert report.unreachable == ("second",)
    assert report.cut_off_m2 > 5
    assert any("second: the robot cannot get there" in doubt for doubt in report.doubts)


def test_opening_that_joins_nothing_is_named(room_data):
    report = report_of(two_rooms(room_data, second_x=(7.0, 10.0)))
    assert any(
        doubt.startswith("openings.0 must touch two rooms along a wall, it touches 1")
        for doubt in report.doubts
    )


def test_start_in_furniture_names_the_piece(room_data):
    data = copy.deepcopy(room_data)
    data["start"] = {"x_m": 5.0, "y_m": 3.0}
    (fault,) = start_faults(WorldFile.model_validate(data))
    assert "start (5, 3) must be 0.26 m from everything, furniture.0 (dining_table) is 0.00 m away" in fault
    assert report_of(data).faults == (fault,)


def test_start_at_a_wall_names_the_wall(room_data):
    data = copy.deepcopy(room_data)
    data["start"] = {"x_m": 0.1, "y_m": 2.0}
    (fault,) = start_faults(WorldFile.model_validate(data))
    assert "a wall is 0.10 m away" in fault


def test_world_without_lamps_is_a_doubt(room_data):
    assert any("no lamps" in doubt for doubt in report_of(room_data).doubts)
