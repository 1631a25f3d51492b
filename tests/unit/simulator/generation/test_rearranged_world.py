"""A world as it may be found later."""

import numpy as np
import pytest

from simulator.generation.generate import generate
from simulator.generation.mending import wrong_at
from simulator.generation.rearranged_world import rearrange_file, rearranged
from simulator.world.world_check import examine
from simulator.world.world_file import WorldFile, WorldFileError, load_world, read_contents, world_path


def lived_in(contents, seed=1, share=0.3):
    return rearranged(contents, WorldFile.model_validate, np.random.default_rng(seed), share)


def places(contents):
    """Kind and place of all furniture that stands on the floor."""
    return {(one["kind"], *one["at_m"]) for one in contents["furniture"] if not one.get("z_m")}


@pytest.mark.parametrize("kind", ["flat", "hostel", "street"])
def test_some_furniture_is_elsewhere_and_the_robot_still_gets_everywhere(kind):
    before = generate(kind, 3, "small")
    after = lived_in(before)
    assert 0 < len(places(before) - places(after)) < 0.5 * len(places(before))
    assert wrong_at(WorldFile.model_validate(after)) is None
    assert after["rooms"] == before["rooms"]


def test_each_seed_changes_a_world_in_its_own_way_and_always_so():
    before = generate("flat", 0, "medium")
    assert lived_in(before, 1) == lived_in(before, 1)
    assert places(lived_in(before, 1)) != places(lived_in(before, 2))


def test_without_a_share_only_light_and_doors_differ():
    before = generate("flat", 0, "medium")
    after = lived_in(before, share=0.0)
    assert places(before) <= places(after)
    assert {kind for kind, *_ in places(after) - places(before)} == {"open_door"}
    assert after["lighting"]["ambient"] != list(WorldFile.model_validate(before).lighting.ambient)


def test_what_stands_on_a_piece_goes_with_it():
    room = {"name": "room", "x_m": [0, 8], "y_m": [0, 8]}
    room |= {
        part: {"texture": "plaster", "colour": [200, 200, 200]} for part in ("floor", "walls", "ceiling")
    }
    table = {"kind": "dining_table", "at_m": [2.0, 2.0]}
    lamp = {"kind": "plant", "at_m": [2.1, 2.0], "z_m": 0.8}
    contents = {
        "format": "topnav-world/1",
        "name": "one table",
        "rooms": [room],
        "start": {"x_m": 7, "y_m": 7},
    }
    seen = set()
    for seed in range(12):
        after = lived_in({**contents, "furniture": [table, lamp]}, seed, share=1.0)["furniture"]
        seen.add(len(after))
        if len(after) == 2:
            (x, y), (x_on, y_on) = (one["at_m"] for one in after)
            assert np.hypot(x_on - x, y_on - y) == pytest.approx(0.1, abs=1e-3)
    assert seen == {0, 2}


@pytest.mark.parametrize("world", ["apartment", "office"])
def test_worlds_drawn_by_hand_are_rearranged_beside_their_names_and_groups(tmp_path, world):
    after = rearrange_file(world, tmp_path / "later.yaml", seed=1)
    before = load_world(world)
    assert not examine(after).faults
    assert after.name == f"{before.name}-rearranged"
    assert read_contents(tmp_path / "later.yaml").get("placed") == read_contents(world_path(world)).get(
        "placed"
    )


def test_a_world_that_is_not_there_is_named(tmp_path):
    with pytest.raises(WorldFileError, match="nowhere"):
        rearrange_file("nowhere", tmp_path / "later.yaml", seed=1)
