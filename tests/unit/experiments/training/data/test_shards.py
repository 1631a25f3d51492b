"""Shards: what was written is read, what was changed is named, what judges is never trained on."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from experiments.training.data.drawing import draw_pairs, require_picture_name
from experiments.training.data.drawn import make_missing, plan_shards
from experiments.training.data.making import make_shard
from experiments.training.data.recipe import DataRecipe
from experiments.training.data.shards import (
    Pair,
    Shard,
    about_shard,
    read_shard,
    shard_files,
    trainable,
    write_shard,
)
from experiments.training.recipe import recipe_from
from experiments.training.sights import CameraPose, Sight
from experiments.training.worlds import WorldName, first_worlds, require_trainable
from services.launcher.client.failure import ExperimentError


def shard_of(world: WorldName) -> tuple[Shard, list[bytes]]:
    sights = [
        Sight(
            np.full((8, 16, 3), 60 * k, np.uint8),
            np.full((8, 16), 1.5 + k),
            CameraPose(k, 2.0, 0.5, 0.8, (0.1, 0.2)),
        )
        for k in range(2)
    ]
    jpegs = [bytes(cv2.imencode(".jpg", sight.picture)[1]) for sight in sights]
    return Shard(world, [Pair(sights[0], sights[1], (0.5, 0.25))], {"recipe": {}}), jpegs


@pytest.fixture
def written(tmp_path):
    (world,) = first_worlds("development", 1)
    return write_shard(tmp_path, f"{world}-000", *shard_of(world))


def test_a_shard_comes_back_as_it_was(written):
    (pair,) = read_shard(written).pairs
    assert pair.there.pose == CameraPose(1.0, 2.0, 0.5, 0.8, (0.1, 0.2))
    assert pair.distance_m == pytest.approx(1.0)
    assert pair.overlap == (0.5, 0.25)
    assert (pair.there.ranges_m == 2.5).all()
    assert abs(int(pair.there.picture[4, 4, 0]) - 60) <= 2
    assert shard_files(written.parent) == [written]


def test_a_shard_drawn_again_takes_the_place_of_the_one_before(written):
    shard, jpegs = shard_of(read_shard(written).world)
    again = write_shard(
        written.parent, written.name[:-21], Shard(shard.world, shard.pairs, {"recipe": 1}), jpegs
    )
    assert again != written
    assert shard_files(written.parent) == [again]


@pytest.mark.parametrize("damage", ["flipped", "cut"])
def test_a_corrupted_shard_is_refused_by_name(written, damage):
    data = bytearray(written.read_bytes())
    data[len(data) // 2] ^= 1
    written.write_bytes(data if damage == "flipped" else data[:-7])
    with pytest.raises(ExperimentError, match=f"{written.name} is corrupted"):
        read_shard(written)


def test_nothing_is_trained_on_a_world_that_judges(tmp_path):
    for split in ("validation", "test"):
        (world,) = first_worlds(split, 1)
        with pytest.raises(ExperimentError, match=f"{world} is of the {split} split"):
            require_trainable([world], "train data")
        path = write_shard(tmp_path, f"{world}-000", *shard_of(world))
        with pytest.raises(ExperimentError, match=f"{world} is of the {split} split"):
            trainable(path)
        plan, *_ = plan_shards([world], "development", 1, 1, DataRecipe(), tmp_path)
        with pytest.raises(ExperimentError, match="was asked for"):
            make_shard(plan)


def test_shards_of_another_recipe_are_not_mixed_in(written):
    world = read_shard(written).world
    plans = plan_shards([world], "development", 1, 1, DataRecipe(), written.parent)
    with pytest.raises(ExperimentError, match="another recipe"):
        make_missing(plans, 1)


def plans_beside(world, folder, pairs=2, **changes):
    """A shard of two pairs drawn by the recipe of `changes`, and the plan for as many as asked."""
    recipe = DataRecipe(**changes)
    (drawn,) = plan_shards([world], "development", 1, 2, recipe, folder)
    shard, jpegs = shard_of(world)
    write_shard(folder, drawn.stem, Shard(world, shard.pairs, drawn.about), jpegs)
    return plan_shards([world], "development", 1, pairs, DataRecipe(), folder)


def test_a_shard_of_the_same_recipe_is_kept_though_the_world_had_room_for_fewer_pairs(tmp_path):
    (world,) = first_worlds("development", 1)
    plans = plans_beside(world, tmp_path)
    assert make_missing(plans, 1) == []
    assert about_shard(plans[0].done)["pairs"] == 1


@pytest.mark.parametrize(
    ("pairs", "changes", "other"),
    [(3, {}, "pairs of a shard 2, now 3"), (2, {"width_px": 512}, "width_px 512, now 1024")],
)
def test_what_differs_from_the_shards_that_are_there_is_named(tmp_path, pairs, changes, other):
    (world,) = first_worlds("development", 1)
    with pytest.raises(ExperimentError, match=other):
        make_missing(plans_beside(world, tmp_path, pairs, **changes), 1)


def test_a_shard_of_a_world_without_room_comes_back_empty(tmp_path):
    (world,) = first_worlds("development", 1)
    path = write_shard(tmp_path, f"{world}-000", Shard(world, [], {"recipe": {}}), [])
    assert trainable(path).pairs == []
    with pytest.raises(ExperimentError, match="no room"):
        draw_pairs(tmp_path / "pairs.png", [])


def test_an_ending_that_is_of_no_picture_is_refused_at_once():
    require_picture_name(Path("pairs.png"))
    with pytest.raises(ExperimentError, match=r"\.png or \.jpg, got pairs\.text"):
        require_picture_name(Path("pairs.text"))


def test_an_empty_folder_says_what_to_do(tmp_path):
    with pytest.raises(ExperimentError, match="topnav train data"):
        shard_files(tmp_path)


def test_a_recipe_file_replaces_values_and_a_wrong_name_is_named(tmp_path):
    file = tmp_path / "r.json"
    file.write_text('{"width_px": 512}')
    assert recipe_from(DataRecipe, file, seed=7) == DataRecipe(width_px=512, seed=7)
    file.write_text('{"width": 512}')
    with pytest.raises(ExperimentError, match="width: Extra inputs"):
        recipe_from(DataRecipe, file)


@pytest.mark.parametrize("values", [{"jpeg": [95, 60]}, {"jpeg": [0, 101]}, {"apart_m": [6.0, 0.2]}, []])
def test_values_that_nothing_can_be_drawn_by_are_named(tmp_path, values):
    file = tmp_path / "r.json"
    file.write_text(json.dumps(values))
    with pytest.raises(ExperimentError, match=next(iter(values), "no JSON object")):
        recipe_from(DataRecipe, file)


@pytest.mark.parametrize("text", ["flat", "flat-x-small", "-3-small", "flut-3-small", "flat-3-tiny"])
def test_a_name_that_is_no_generated_world_is_refused(text):
    with pytest.raises(ExperimentError, match="flat-3-small"):
        WorldName.parse(text)


def test_names_are_read_as_they_are_written():
    for world in first_worlds("development", 12):
        assert WorldName.parse(str(world)) == world
