"""A matcher's training goes on after an interruption to the same bits; the detector may be our own."""

import json

import pytest
from safetensors import safe_open

from experiments.training.detector import training as detector
from experiments.training.detector.recipe import KeypointsRecipe
from experiments.training.learning.running import Schedule
from experiments.training.matcher import examples
from experiments.training.matcher.recipe import MatcherRecipe
from experiments.training.matcher.training import train
from experiments.training.sealed import sealed_files
from services.launcher.client.failure import ExperimentError
from tests.unit.experiments.training.places import in_this_process

RECIPE = MatcherRecipe(
    keypoints=40,
    width=16,
    heads=2,
    layers=2,
    batch=3,
    schedule=Schedule(steps=4, kept_every=2, warmup=1, clip=1.0),
)
OWN = RECIPE.model_copy(update={"features": "own"})


@pytest.fixture(autouse=True)
def _here(monkeypatch):
    monkeypatch.setattr(examples, "workers", in_this_process)


def trained(places, folder, name, recipe=RECIPE, until=None, export=None):
    return train(places.files[0].parent, folder / name, folder / "detector", recipe, "cpu", until, export, 1)


def ends(folder, step):
    return [file.name for file in sealed_files(folder, f"step-{step:08d}", ".safetensors")]


def test_interrupted_training_goes_on_to_the_same_bits_and_gives_away_what_it_learned(places, tmp_path):
    weights = tmp_path / "weights.safetensors"
    whole = trained(places, tmp_path, "whole", export=weights)
    assert trained(places, tmp_path, "pieces", until=3)["steps"] == 3
    assert trained(places, tmp_path, "pieces")["steps"] == 4
    assert (whole["panoramas"], whole["pairs"], whole["steps"]) == (6, 8, 4)
    assert ends(tmp_path / "whole", 4) == ends(tmp_path / "pieces", 4) != []  # with their checksums
    with safe_open(weights, "pt") as file:
        assert json.loads(file.metadata()["recipe"]) == json.loads(RECIPE.model_dump_json())
        assert file.get_tensor("enter.weight").shape == (16, 128 + 4)


def test_own_features_are_those_of_the_detectors_checkpoint(places, tmp_path):
    with pytest.raises(ExperimentError, match="train one with 'topnav train keypoints --into"):
        trained(places, tmp_path, "into", OWN)
    recipe = KeypointsRecipe(batch=1, points=32, keypoints=32, schedule=Schedule(steps=1))
    detector.train(places.files[0].parent, tmp_path / "detector", recipe, "cpu", None, None, 1)
    weights = tmp_path / "weights.safetensors"
    assert trained(places, tmp_path, "into", OWN, until=1, export=weights)["steps"] == 1
    with safe_open(weights, "pt") as file:
        assert file.get_tensor("enter.weight").shape == (16, 64 + 4)
    for checkpoint in sealed_files(tmp_path / "detector", "step-*", ".safetensors"):
        checkpoint.unlink()
    with pytest.raises(ExperimentError, match="no checkpoint in"):
        trained(places, tmp_path, "into", OWN)
