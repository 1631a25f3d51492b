"""World files: the one that ships loads, and bad ones say what is wrong and where."""

import copy

import pytest
import yaml

from simulator.world.contents import expand
from simulator.world.world_file import WorldFileError, load_world, world_names


def test_every_shipped_world_loads_and_has_solids_and_lights():
    for name in world_names():
        world = load_world(name)
        parts, lights = expand(world)
        assert sum(p.solid for p in parts) > 50
        assert lights or world.sun


def edit(data, path, value):
    changed = copy.deepcopy(data)
    target = changed
    for key in path[:-1]:
        target = target[key]
    if value is None:
        del target[path[-1]]
    else:
        target[path[-1]] = value
    return changed


@pytest.mark.parametrize(
    ("path", "value", "message"),
    [
        (("rooms", 0, "x_m"), [6, 0], r"rooms\.0\.x_m.*low < high"),
        (
            ("rooms", 0, "walls", "texture"),
            "velvet",
            r"rooms\.0\.walls\.texture.*unknown texture kind 'velvet'",
        ),
        (("rooms", 0, "floor", "colour"), [1, 2, 300], r"rooms\.0\.floor\.colour\.2"),
        (("rooms",), [], r"at least one room or one ground"),
        (("furniture", 0, "kind"), "throne", r"unknown furniture kind 'throne'; choose from armchair"),
        (("furniture", 0, "options"), {"wheels": 4}, r"dining_table has no option wheels; it has length_m"),
        (("furniture", 0, "options"), {"length_m": "long"}, r"dining_table options: length_m"),
        (
            ("start",),
            {"x_m": 40, "y_m": 1},
            r"start \(40.0, 1.0\) must lie inside one of the rooms or grounds \['room'\]",
        ),
        (("format",), "topnav-world/9", r"format.*topnav-world/1"),
        (("name",), None, r"name: Field required"),
        (("wall_height_m",), float("nan"), r"wall_height_m"),
        (("colour",), "red", r"colour: Extra inputs"),
    ],
)
def test_fault_is_named_with_its_place(room_data, tmp_path, path, value, message):
    file = tmp_path / "bad.yaml"
    file.write_text(yaml.safe_dump(edit(room_data, path, value)))
    with pytest.raises(WorldFileError, match=message):
        load_world(str(file))


def test_unknown_world_lists_the_known_ones():
    with pytest.raises(WorldFileError, match=r"one of .*apartment.*got 'palace'"):
        load_world("palace")


@pytest.mark.parametrize("text", ["a: [1, 2", "- just\n- a list\n", ""])
def test_file_that_is_no_mapping_is_refused(tmp_path, text):
    file = tmp_path / "bad.yaml"
    file.write_text(text)
    with pytest.raises(WorldFileError, match=r"not valid YAML|must be a mapping"):
        load_world(str(file))
