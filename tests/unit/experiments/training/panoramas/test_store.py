"""Tensors of panoramas say of every point what the shards they were read from say."""

from itertools import product

import cv2
import numpy as np
import pytest
import torch

from experiments.training.data.shards import Shard, write_shard
from experiments.training.panoramas.store import CROP_DEG, RESIZE, load_panoramas
from experiments.training.sights import BAND_RAD, overlap, projected
from experiments.training.worlds import first_worlds
from services.features.pipeline.named_pipelines import find_profile
from services.features.representations.equirectangular import PAD_COLUMNS, Equirectangular
from services.launcher.client.failure import ExperimentError
from shared.geometry.sphere import bearings_from_lonlat
from tests.unit.experiments.training.patch.painted import painted_pair, write_painted
from tests.unit.experiments.training.places import CPU, HALF_UNKNOWN, HIDDEN


@pytest.mark.parametrize("numbers", [(0, 1), (1, 0), (HALF_UNKNOWN, 1), (1, HALF_UNKNOWN), (0, HIDDEN)])
def test_a_point_is_where_the_sights_themselves_say(places, numbers):
    rng = np.random.default_rng(5)
    asked = np.stack([rng.uniform(-np.pi, np.pi, 400), rng.uniform(-BAND_RAD, BAND_RAD, 400)], axis=-1)
    here, there = (places.sights[number] for number in numbers)
    expected, shown = projected(asked, here, there)
    batch = torch.from_numpy(np.stack([asked, asked[::-1]])).float()
    ends = (torch.tensor([number, number]) for number in numbers)
    bearings, visible, known = (part.numpy() for part in places.panoramas.seen_from(batch, *ends))
    surface = np.isfinite(here.ranges_at(asked))
    assert (known[0] == surface).mean() > 0.99  # a float32 falls into the pixel beside it now and then
    assert (visible[0] == shown).mean() > 0.99
    sure = known[0] & surface
    cosines = (bearings[0] * bearings_from_lonlat(expected)).sum(axis=-1)[sure]
    assert (cosines > np.cos(1e-3)).mean() > 0.99
    np.testing.assert_allclose(bearings[1], bearings[0, ::-1], atol=1e-6)  # each row is for itself


def test_overlap_is_that_of_the_sights_and_none_between_shards(places):
    table = places.panoramas.overlap
    for one, other in product(range(4), repeat=2):
        told = overlap(places.sights[one], places.sights[other])
        assert float(table[one, other]) == pytest.approx(told, abs=0.04), (one, other)
    assert 0.3 < float(table[HALF_UNKNOWN, 0]) < 0.7
    assert table[:4, 4:].abs().max() == table[4:, :4].abs().max() == 0.0  # though their boxes are the same
    assert places.panoramas.shard.tolist() == [0, 0, 0, 0, 1, 1]


def test_strips_are_what_the_pipelines_look_at(places):
    profile = find_profile("sift")
    assert (profile.crop_deg, profile.resize) == (CROP_DEG, RESIZE)
    for sight, strip in zip(places.sights, places.panoramas.strips, strict=True):
        (view,) = Equirectangular(profile).views(_grey(sight.picture))
        assert np.array_equal(view.gray[:, PAD_COLUMNS:-PAD_COLUMNS], strip.numpy())


def test_more_shards_than_threads_keep_their_order(places):
    again = load_panoramas([*places.files[::-1], *places.files], CPU, threads=1)
    assert torch.equal(again.strips[2:6], places.panoramas.strips[:4])
    assert again.shard.tolist() == [0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3]


def test_a_world_that_judges_is_refused(tmp_path, places):
    (world,) = first_worlds("validation", 1)
    shard = write_painted(tmp_path, world, [painted_pair()])
    with pytest.raises(ExperimentError, match=f"{world} is of the validation split"):
        load_panoramas([places.files[0], shard], CPU)


def test_a_shard_without_pairs_is_left_out_and_nothing_else_is_named(tmp_path, places):
    (world,) = first_worlds("development", 1)
    empty = write_shard(tmp_path, "empty", Shard(world, [], {"recipe": {}}), [])
    beside = load_panoramas([empty, places.files[1]], CPU)
    assert len(beside) == 2
    assert beside.shard.unique().numel() == 1
    with pytest.raises(ExperimentError, match="draw more with 'topnav train data'"):
        load_panoramas([empty], CPU)


def _grey(picture: np.ndarray) -> np.ndarray:
    return np.asarray(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), np.uint8)
