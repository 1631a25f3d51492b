"""Patches of all shards: numbered, bounded, the same with more processes, of no world that judges."""

import numpy as np
import pytest

from experiments.training.data.shards import Pair
from experiments.training.patch.reading import read_patches
from experiments.training.patch.samples import Sampling
from experiments.training.worlds import first_worlds
from services.launcher.client.failure import ExperimentError
from tests.unit.experiments.training.patch.painted import painted_pair, write_painted

RECIPE = Sampling(keypoints=120, per_pair=40)


@pytest.fixture(scope="module")
def shards(tmp_path_factory):
    """Two of different worlds: two pairs and one pair, beside one of places that do not see each other."""
    folder, pair = tmp_path_factory.mktemp("pairs"), painted_pair()
    strangers = Pair(pair.here, pair.there, (0.0, 0.0))
    return [
        write_painted(folder, world, pairs)
        for world, pairs in zip(
            first_worlds("development", 2), ([pair, strangers, pair], [pair]), strict=True
        )
    ]


def test_pairs_and_worlds_are_numbered_through(shards):
    found = read_patches(shards, RECIPE)
    assert found.begins.tolist() == [0, 40, 80]
    assert found.panoramas[found.begins].tolist() == [0, 1, 2]
    assert found.worlds[found.begins].tolist() == [0, 0, 1]
    assert not np.array_equal(found.pictures[:40], found.pictures[40:80])  # each pair draws by itself


def test_another_process_reads_the_same(shards):
    one, two = read_patches(shards, RECIPE), read_patches(shards, RECIPE, jobs=2)
    assert np.array_equal(one.pictures, two.pictures)
    assert np.array_equal(one.worlds, two.worlds)


def test_no_more_are_read_than_the_recipe_says(shards):
    found = read_patches(shards, RECIPE.model_copy(update={"most": 30}))
    assert len(found) <= 30
    assert len(found.begins) == 3


def test_a_shard_of_a_world_that_judges_is_refused(tmp_path):
    (world,) = first_worlds("test", 1)
    with pytest.raises(ExperimentError, match="of the test split"):
        read_patches([write_painted(tmp_path, world, [])], RECIPE)
