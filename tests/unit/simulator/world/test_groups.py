"""Groups of furniture: copies stand where they were placed, differ where they are told to, or are refused."""

import math

import numpy as np
import pytest
import yaml

from simulator.scene.texturing import texture_offset
from simulator.world.contents import expand, placed
from simulator.world.items import MOST_ITEMS
from simulator.world.world_file import WorldFile, WorldFileError, load_world

SEAT = [
    {"name": "table", "kind": "round_table", "at_m": [1.0, 0.0], "seed": 2},
    {"name": "chair", "kind": "chair", "at_m": [0.0, 0.5], "yaw_deg": 30, "options": {"colour": [1, 2, 3]}},
    {"kind": "pouf", "at_m": [0.0, 0.0]},
]


@pytest.fixture
def with_groups(room_data):
    def make(*placements, groups=None, **keys):
        data = {**room_data, "groups": groups or {"seat": SEAT}, "placed": list(placements), **keys}
        return WorldFile.model_validate(data)

    return make


def test_copies_follow_the_worlds_own_furniture_turned_and_named(with_groups):
    world = with_groups({"group": "seat", "name": "north", "at_m": [2.0, 1.0], "yaw_deg": 90})
    own, table, chair, pouf = world.furniture
    assert own.kind == "dining_table"
    assert (table.name, table.at_m, table.yaw_deg, table.seed) == ("north table", (2.0, 2.0), 90.0, 2)
    assert (chair.name, chair.at_m, chair.yaw_deg) == ("north chair", (1.5, 1.0), 120.0)
    assert pouf.name is None


def test_a_placed_piece_is_the_piece_of_the_group_moved(with_groups):
    here, there = with_groups(
        {"group": "seat", "at_m": [1.0, 1.0]}, {"group": "seat", "at_m": [4.0, 2.5], "yaw_deg": -90}
    ).furniture[1:5:3]
    one, other = (placed(item).parts[0] for item in (here, there))
    assert one.size_m == other.size_m
    assert one.material == other.material
    assert other.yaw_rad - one.yaw_rad == pytest.approx(-math.pi / 2)


def test_changes_replace_keys_and_single_options_and_leave_items_out(with_groups):
    changed = {
        "table": None,
        "chair": {"seed": 9, "yaw_deg": 0, "options": {"cushion": [4, 5, 6]}},
    }
    world = with_groups({"group": "seat", "at_m": [2.0, 2.0], "changed": changed})
    chair, pouf = world.furniture[1:]
    assert (chair.seed, chair.yaw_deg) == (9, 0.0)
    assert chair.options == {"colour": [1, 2, 3], "cushion": [4, 5, 6]}
    assert pouf.kind == "pouf"


def test_a_world_is_written_with_its_copies_and_without_groups(with_groups):
    world = with_groups({"group": "seat", "name": "a", "at_m": [2.0, 2.0]})
    again = WorldFile.model_validate(world.model_dump(mode="json"))
    assert again.furniture == world.furniture
    assert not again.placed


def test_equal_pieces_show_the_same_grain_only_where_the_world_says_so(with_groups):
    pair = [{"group": "seat", "at_m": at} for at in ([1.0, 1.0], [4.0, 1.0])]
    for alike in (True, False):
        parts, _ = expand(with_groups(*pair, alike=alike))
        poufs = [part for part in parts if part.shape == "cushion" and part.material.kind == "pattern_cloth"]
        offsets = [texture_offset(part) for part in poufs]
        assert len(offsets) == 2
        assert np.allclose(*offsets) == alike


@pytest.mark.parametrize(
    ("placement", "message"),
    [
        ({"group": "stool", "at_m": [0, 0]}, r"placed\.0: unknown group 'stool'; groups are seat"),
        (
            {"group": "seat", "at_m": [0, 0], "changed": {"sofa": None}},
            r"placed\.0: changed: group 'seat' has no item named sofa; it has chair, table",
        ),
        (
            {"group": "seat", "at_m": [0, 0], "changed": {"chair": {"seed": -1}}},
            r"placed\.0\.changed: seed Input should be greater than or equal to 0",
        ),
        (
            {"group": "seat", "at_m": [0, 0], "changed": {"chair": {"options": {"wheels": 4}}}},
            r"placed\.0\.changed: .*chair has no option wheels",
        ),
        (
            {"group": "seat", "at_m": [499.5, 0]},
            r"placed\.0: .*within \+-500 m, round_table is at \(500.5, 0\)",
        ),
        ({"group": "seat"}, r"placed\.0\.at_m: Field required"),
    ],
)
def test_a_placement_that_does_not_fit_is_named_with_its_place(room_data, tmp_path, placement, message):
    file = tmp_path / "bad.yaml"
    file.write_text(yaml.safe_dump({**room_data, "groups": {"seat": SEAT}, "placed": [placement]}))
    with pytest.raises(WorldFileError, match=message):
        load_world(str(file))


def test_copies_count_as_furniture(with_groups):
    many = [{"group": "seat", "at_m": [1.0, 1.0]}] * (MOST_ITEMS // len(SEAT))
    with pytest.raises(ValueError, match=r"must be at most 3000, got 1 and 3000 placed"):
        with_groups(*many)
    with pytest.raises(ValueError, match=r"at most 3000 pieces of furniture, got 3003"):
        with_groups(*many, many[0])


def test_two_copies_of_one_name_are_refused(with_groups):
    copy = {"group": "seat", "name": "a", "at_m": [1.0, 1.0]}
    with pytest.raises(ValueError, match="names of furniture must be unique; twice: a chair, a table"):
        with_groups(copy, copy)
