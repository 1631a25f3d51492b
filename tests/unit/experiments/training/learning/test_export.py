"""Weights that are given away: half precision, what they are, small, and kornia's."""

import kornia.feature as kf
import pytest
import torch
from safetensors import safe_open
from safetensors.torch import load_file

from experiments.training.learning.export import exported
from services.features.networks.patch_shapes import network_named
from services.launcher.client.failure import ExperimentError


def test_kornia_loads_what_was_exported_and_describes_nearly_the_same(tmp_path):
    network, path = network_named("hardnet"), tmp_path / "new" / "hardnet.safetensors"
    patches = torch.rand((8, 1, 32, 32), generator=torch.Generator().manual_seed(1))
    network(patches)  # statistics of a batch
    size = exported(network, path, {"name": "ours", "licence": "Apache-2.0"})
    assert size == path.stat().st_size <= 4_000_000
    with safe_open(path, "pt") as file:
        assert file.metadata() == {"name": "ours", "licence": "Apache-2.0"}
    values = load_file(path)
    assert {value.dtype for value in values.values()} == {torch.float16, torch.int64}
    theirs = kf.HardNet(pretrained=False).eval()
    theirs.load_state_dict(values)
    with torch.no_grad():
        cosines = (theirs(patches) * network.eval()(patches)).sum(dim=1)
    assert cosines.min() > 0.9999
    assert [file.name for file in path.parent.iterdir()] == [path.name]


def test_a_diverged_network_is_not_given_away(tmp_path):
    network = torch.nn.Linear(2, 2)
    network.weight.data[0, 0] = 1e6
    with pytest.raises(ExperimentError, match="weight does not fit into half precision"):
        exported(network, tmp_path / "weights", {})
    assert not (tmp_path / "weights").exists()


def test_a_file_too_large_to_be_given_away_is_refused(tmp_path):
    with pytest.raises(ExperimentError, match="at most 4000000"):
        exported(torch.nn.Linear(1500, 1500), tmp_path / "weights", {})
    assert not (tmp_path / "weights").exists()
