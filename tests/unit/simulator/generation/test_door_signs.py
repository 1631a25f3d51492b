"""Door signs: one at every door of a corridor, each number once, in sight, and nothing else changed."""

from dataclasses import replace

import pytest

from simulator.generation.generate import generate
from simulator.generation.kinds import KINDS
from simulator.world.world_file import WorldFile

SIGNED = ("hostel", "school", "offices")


def signs_of(world):
    return [item for item in world["furniture"] if item["kind"] == "door_sign"]


@pytest.mark.parametrize("kind", SIGNED)
def test_every_room_of_a_corridor_has_a_number_of_its_own_beside_its_door(kind):
    world = generate(kind, 3, "medium")
    rooms = [room for room in world["rooms"] if room["name"].startswith(("north", "south"))]
    texts = [sign["options"]["text"] for sign in signs_of(world)]
    assert len(set(texts)) == len(texts) == len(rooms)
    for room in rooms:
        near = [sign for sign in signs_of(world) if room["x_m"][0] < sign["at_m"][0] < room["x_m"][1]]
        assert {int(sign["options"]["text"]) % 2 for sign in near} == {0, 1}, "odd on one side, even opposite"
    assert WorldFile.model_validate(world).furniture[-1].kind == "door_sign"


@pytest.mark.parametrize("kind", SIGNED)
def test_rooms_and_furniture_are_those_of_the_world_without_signs(kind, monkeypatch):
    signed = generate(kind, 4, "small")
    monkeypatch.setitem(KINDS, kind, replace(KINDS[kind], signs=False))
    bare = generate(kind, 4, "small")
    assert signs_of(bare) == []
    assert signed == {**bare, "furniture": bare["furniture"] + signs_of(signed)}


@pytest.mark.parametrize("kind", SIGNED)
@pytest.mark.parametrize("seed", [0, 3, 5])
def test_no_picture_hangs_over_a_sign(kind, seed):
    world = generate(kind, seed, "medium")
    for sign in signs_of(world):
        for item in world["furniture"]:
            apart = max(abs(a - b) for a, b in zip(item["at_m"], sign["at_m"], strict=True))
            flat = item["kind"] in ("picture", "notice_board", "clock", "mirror", "fuse_box")
            assert not (flat and apart < sign["options"]["width_m"] / 2 and item["z_m"] < 2.0), (sign, item)
