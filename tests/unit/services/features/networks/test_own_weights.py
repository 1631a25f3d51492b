"""Weights that come with topnav: whole, small enough, and refused by name where they were changed."""

import hashlib

import pytest

torch = pytest.importorskip("torch")

from safetensors.torch import save  # noqa: E402

from services.features.networks import cache, catalogue, own_weights  # noqa: E402
from services.features.networks.cache import path_of, state_of  # noqa: E402
from services.features.networks.catalogue import OWN, TrainedModel  # noqa: E402
from services.features.networks.loaders import load  # noqa: E402
from services.features.networks.runtime import WeightsError  # noqa: E402

MOST_BYTES, ALL_BYTES = 4_000_000, 12_000_000
"""Of a file and of all of them: they travel with the code."""


@pytest.fixture
def model(monkeypatch, tmp_path):
    """A model of ours whose file is in a folder of the test."""
    data = save(
        {"layer.weight": torch.ones(2, 3).half(), "count": torch.tensor(7)}, {"recipe": '{"width": 64}'}
    )
    (tmp_path / "thing.safetensors").write_bytes(data)
    seal = hashlib.sha256(data).hexdigest()
    made = TrainedModel(
        "thing", "thing.safetensors", "Apache-2.0", "here", ("thing",), len(data), seal, source="topnav"
    )
    monkeypatch.setattr(cache, "OWN_FOLDER", tmp_path)
    monkeypatch.setattr(catalogue, "MODELS", (made,))
    return made


def test_parameters_come_in_single_precision_with_their_recipe(model):
    tensors, recipe = own_weights.own_weights(model.name)
    assert tensors["layer.weight"].dtype == torch.float32
    assert tensors["count"].dtype == torch.int64
    assert recipe == {"width": 64}
    assert state_of(model) == "verified"


def test_a_changed_file_is_named_and_refused(model):
    path = path_of(model)
    path.write_bytes(path.read_bytes()[:-1] + b"x")
    with pytest.raises(WeightsError, match=r"thing\.safetensors has the checksum .*install topnav again"):
        own_weights.own_weights(model.name)
    assert state_of(model) == "broken"


def test_a_plugin_whose_weights_do_not_come_yet_says_so():
    with pytest.raises(WeightsError, match="no weights of nothing come with topnav yet"):
        own_weights.own_weights("nothing")


def test_a_missing_file_is_named(model):
    path_of(model).unlink()
    with pytest.raises(WeightsError, match=r"thing\.safetensors: No such file.*install topnav again"):
        own_weights.own_weights(model.name)


def test_what_is_no_file_of_weights_is_named_even_if_it_is_the_promised_one(model, monkeypatch):
    path_of(model).write_bytes(b"text")
    promised = TrainedModel(**{**model.__dict__, "sha256": hashlib.sha256(b"text").hexdigest()})
    monkeypatch.setattr(catalogue, "MODELS", (promised,))
    with pytest.raises(WeightsError, match="weights of thing cannot be read"):
        own_weights.own_weights(model.name)


@pytest.mark.parametrize("model", OWN, ids=lambda model: model.name)
def test_what_comes_with_topnav_is_whole_small_and_loads(model):
    assert state_of(model) == "verified"
    assert path_of(model).stat().st_size == model.size_bytes <= MOST_BYTES
    load(model)


def test_all_weights_together_are_small():
    assert sum(model.size_bytes for model in OWN) <= ALL_BYTES
