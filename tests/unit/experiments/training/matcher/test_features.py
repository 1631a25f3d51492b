"""Tables hold what extractors find: a row for each panorama, what is missing marked and at the end."""

import math

import numpy as np
import pytest
import torch

from experiments.training.detector.recipe import KeypointsRecipe, beginning
from experiments.training.matcher import features
from experiments.training.matcher.features import extracted, found_by, table_of
from experiments.training.panoramas.strips import grid_of
from experiments.training.sights import Sight
from services.features.networks.attention import CONTEXT
from services.features.networks.spherical_keypoints import described, strongest
from services.features.representations.equirectangular import PAD_COLUMNS
from services.launcher.client.failure import ExperimentError

MANY = 15_000
"""More than there are peaks."""


def test_a_network_finds_what_its_extractor_would_in_each_strip(places, monkeypatch):
    monkeypatch.setattr(features, "BATCH", 4)
    network = beginning(KeypointsRecipe()).network.eval()
    found = found_by(network, places.panoramas, MANY)
    assert len(found) == 6
    assert all(200 < len(one) < MANY for one in found)
    assert max(float(np.abs(one.lonlat_rad[:, 1]).max()) for one in found) <= math.radians(65.0)
    strip = places.panoramas.strips[5].numpy()
    wide = np.pad(strip, ((0, 0), (PAD_COLUMNS, PAD_COLUMNS)), mode="wrap")
    with torch.no_grad():
        scores, maps = network(torch.from_numpy(wide)[None, None].float() / 255.0)
        pixels, values = strongest(scores, 200, PAD_COLUMNS)
        vectors = described(maps, network.strides, pixels)[0]
    lonlat = grid_of(256).lonlat_from_pixels(pixels[0].numpy() - [PAD_COLUMNS, 0.0])
    turns = (found[5].lonlat_rad[:200] - lonlat + np.pi) % (2.0 * np.pi) - np.pi
    np.testing.assert_allclose(turns, 0.0, atol=1e-4)
    np.testing.assert_allclose(found[5].descriptors[:200], vectors.numpy(), atol=2e-3)
    np.testing.assert_allclose(found[5].scores[:200], values[0].sigmoid().numpy(), atol=1e-4)


def test_of_a_pipeline_each_panorama_has_unit_descriptors_and_what_is_missing_is_marked(places):
    one = places.sights[0]
    grey = Sight(np.full_like(one.picture, 128), one.ranges_m, one.pose)
    found = extracted([one, grey], "sift", 400)
    table = table_of(found, 400)
    assert table.present.shape == (2, 400)
    assert table.context.shape == (2, 400, CONTEXT)
    assert table.present[0].all()  # though the pipeline itself is content with fewer
    assert not table.present[1].any()
    np.testing.assert_allclose(table.lonlat_rad[0].numpy(), found[0].lonlat_rad)
    lengths = table.descriptors.float().norm(dim=-1)
    np.testing.assert_allclose(lengths[table.present].numpy(), 1.0, atol=2e-3)
    assert lengths[~table.present].eq(0.0).all()
    batch = table.of(torch.tensor([1, 0]))
    assert torch.equal(batch.present, table.present[[1, 0]])
    assert batch.descriptors.dtype == torch.float32


def test_bits_are_refused(places):
    with pytest.raises(ExperimentError, match="the descriptors of orb are bits"):
        extracted(places.sights[:1], "orb", 50)
