"""Tables hold what extractors find: a row for each panorama, what is missing marked and at the end."""

import math

import numpy as np
import pytest
import torch

from experiments.training.data.shards import Pair, Shard, write_shard
from experiments.training.detector.recipe import KeypointsRecipe, beginning
from experiments.training.matcher import features
from experiments.training.matcher.features import extracted, found_by
from experiments.training.panoramas.strips import grid_of
from experiments.training.sights import Sight
from experiments.training.worlds import first_worlds
from services.features.networks.attention import CONTEXT
from services.features.networks.spherical_keypoints import described, strongest
from services.features.representations.equirectangular import PAD_COLUMNS
from services.launcher.client.failure import ExperimentError
from tests.unit.experiments.training.patch.painted import write_painted
from tests.unit.experiments.training.places import in_this_process

MANY = 15_000
"""More than there are peaks."""


def test_the_table_of_a_network_is_what_it_finds_in_each_strip(places, monkeypatch):
    monkeypatch.setattr(features, "BATCH", 4)
    network = beginning(KeypointsRecipe()).network.eval()
    table = found_by(network, places.panoramas, MANY)
    assert table.lonlat_rad.shape == (6, MANY, 2)
    assert table.descriptors.shape == (6, MANY, network.dimension)
    assert table.context.shape == (6, MANY, CONTEXT)
    assert float(table.lonlat_rad[..., 1].abs().max()) <= math.radians(65.0)
    strip = places.panoramas.strips[5].numpy()
    wide = np.pad(strip, ((0, 0), (PAD_COLUMNS, PAD_COLUMNS)), mode="wrap")
    with torch.no_grad():
        scores, maps = network(torch.from_numpy(wide)[None, None].float() / 255.0)
        pixels, values = strongest(scores, 200, PAD_COLUMNS)
        vectors = described(maps, network.strides, pixels)[0]
    lonlat = grid_of(256).lonlat_from_pixels(pixels[0].numpy() - [PAD_COLUMNS, 0.0])
    turns = (table.lonlat_rad[5, :200].numpy() - lonlat + np.pi) % (2.0 * np.pi) - np.pi
    np.testing.assert_allclose(turns, 0.0, atol=1e-4)
    np.testing.assert_allclose(table.descriptors[5, :200].float().numpy(), vectors.numpy(), atol=2e-3)
    strengths = np.log(values[0].sigmoid().numpy() / 0.1)
    np.testing.assert_allclose(table.context[5, :200, 3].numpy(), strengths, atol=1e-3)
    counts = table.present.sum(1)
    assert (counts > 200).all()
    assert (counts < MANY).all()
    assert all(row[:count].all() for row, count in zip(table.present, counts.tolist(), strict=True))


def test_of_a_pipeline_each_panorama_has_unit_descriptors_and_what_is_missing_is_marked(places, tmp_path):
    (world,) = first_worlds("development", 1)
    one = places.sights[0]
    grey = Sight(np.full_like(one.picture, 128), one.ranges_m, one.pose)
    shard = write_painted(tmp_path, world, [Pair(one, grey, (1.0, 1.0))])
    table = extracted([shard], "sift", 400, 1)
    assert table.present.shape == (2, 400)
    assert table.present[0].all()  # though the pipeline itself is content with fewer
    assert not table.present[1].any()
    lengths = table.descriptors.float().norm(dim=-1)
    np.testing.assert_allclose(lengths[table.present].numpy(), 1.0, atol=2e-3)
    assert lengths[~table.present].eq(0.0).all()
    batch = table.of(torch.tensor([1, 0]))
    assert torch.equal(batch.present, table.present[[1, 0]])
    assert batch.descriptors.dtype == torch.float32


def test_a_shard_without_pairs_is_left_out(places, tmp_path, monkeypatch):
    monkeypatch.setattr(features, "workers", in_this_process)
    (world,) = first_worlds("development", 1)
    empty = write_shard(tmp_path, "empty", Shard(world, [], {"recipe": {}}), [])
    assert extracted([empty, places.files[1], empty], "sift", 50, 1).present.shape == (2, 50)
    with pytest.raises(ExperimentError, match="draw more with 'topnav train data'"):
        extracted([empty], "sift", 50, 1)
