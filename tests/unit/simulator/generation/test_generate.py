"""Worlds nobody drew: valid, reachable, the same for the same seed, and said to be what they are for."""

import os

import pytest

from simulator.generation.generate import generate
from simulator.generation.kinds import KINDS, SIZES
from simulator.generation.mending import GenerationError
from simulator.generation.world_text import as_yaml
from simulator.world.world_check import examine
from simulator.world.world_file import WorldFile, load_world

SEEDS = range(int(os.environ.get("GENERATED_SEEDS", "3")))
"""Of every kind; a hundred take half an hour."""


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("kind", KINDS)
def test_every_seed_is_a_world_in_which_the_robot_gets_everywhere(kind, seed):
    world = WorldFile.model_validate(generate(kind, seed, SIZES[seed % len(SIZES)]))
    report = examine(world)
    assert (report.faults, report.doubts, report.unreachable) == ((), (), ())
    assert report.free_m2 > 0.25 * report.floor_m2
    assert len(world.furniture) > 0.08 * report.floor_m2 if world.rooms else len(world.furniture) > 5


def test_what_is_written_is_what_was_drawn(tmp_path):
    world = generate("flat", 3, "small")
    file = tmp_path / "flat.yaml"
    file.write_text(as_yaml(world), encoding="utf-8")
    read = load_world(str(file))
    assert read == WorldFile.model_validate(world)
    assert read.generated.model_dump() == {"kind": "flat", "seed": 3, "size": "small", "split": "test"}


@pytest.mark.parametrize("kind", ["flat", "hostel", "yard"])
def test_the_same_seed_gives_the_same_world_and_another_one_another(kind):
    assert as_yaml(generate(kind, 5, "small")) == as_yaml(generate(kind, 5, "small"))
    assert as_yaml(generate(kind, 5, "small")) != as_yaml(generate(kind, 6, "small"))


def test_rooms_of_a_hostel_are_furnished_alike_but_for_small_things():
    world = generate("hostel", 4, "medium")
    assert world["alike"]
    assert len([item for item in world["furniture"] if item["kind"] == "bed"]) == 8
    beds = [item["options"] for item in world["furniture"] if item["kind"] == "bed"]
    assert all(options == beds[0] for options in beds)
    pictures = [item for item in world["furniture"] if item["kind"] == "picture"]
    assert len({(item.get("seed"), item["options"]["style"]) for item in pictures}) > 4


def test_what_there_is_not_is_refused_with_what_there_is():
    with pytest.raises(GenerationError, match=r"kind must be one of flat, .*; got 'castle'"):
        generate("castle", 1)
    with pytest.raises(GenerationError, match=r"size must be one of small, medium, large; got 'vast'"):
        generate("flat", 1, "vast")
